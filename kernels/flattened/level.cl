// The kernels of the stages that every call runs, as one program: compiling the headers once saves PoCL a second at the
// first call. The end game, strips and regions are separate, because they define macros for their headers.

#include "flattened/border.cl"
#include "flattened/canonical.cl"
#include "flattened/chains.cl"
#include "flattened/children.cl"
#include "flattened/cut.cl"
#include "flattened/hull_depth.cl"
#include "flattened/ingest.cl"
#include "flattened/lists.cl"
#include "flattened/merge.cl"
#include "flattened/neighbors.cl"
#include "flattened/output.cl"
#include "flattened/project.cl"
#include "flattened/prune.cl"
