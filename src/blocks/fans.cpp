#include "blocks/stages.hpp"
#include "launchers/blocks/fans.cl.hpp"

namespace flaunay::blocks {

void make_fans(Workspace& work, const Blocks& blocks, const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  const std::size_t pairs = rings.edges.size() / 2;
  const auto inside = work.scratch().allocate<cl_uchar>(pairs);
  const auto found = work.scratch().allocate<cl_uchar>(pairs);
  runtime.map(
      pairs,
      kernels::find_inside{
          .bound = work.bounds.circle, .points = blocks.vertices, .edges = rings.edges, .inside = inside});
  runtime.map(blocks.points, kernels::leave_inside{
                                 .edges = rings.edges, .inside = inside, .vertex_edge = rings.vertex_edge});
  runtime.map(pairs, kernels::find_fans{
                         .points = blocks.vertices, .edges = rings.edges, .inside = inside, .found = found});
  runtime.map(pairs, kernels::build_fans{.inside = inside, .found = found, .edges = rings.edges});
}

}  // namespace flaunay::blocks
