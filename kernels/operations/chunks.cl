// The vector operations by chunks, as one program.

#include "operations/pack.cl"
#include "operations/scan.cl"
#include "operations/sort.cl"
