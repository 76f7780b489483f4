#include "flattened/stages.hpp"

namespace flaunay::flattened {

void strips(Workspace&, const PointTable&, const RetiredRegions&, const Buffer<cl_int>&, std::size_t,
            const Buffer<cl_uint>&) {
  throw Error(ErrorKind::internal, "large regions: to do");
}

}  // namespace flaunay::flattened
