// The same, with differences that are converted by halves.
#define CONVERT_HALVES
#include "fixed_predicates.cl"
