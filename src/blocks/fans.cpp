#include "blocks/parts.hpp"
#include "blocks/pipeline.hpp"
#include "launchers/blocks/fans.cl.hpp"

namespace flaunay::blocks {
using namespace points;

void make_fans(Workspace& work, const Blocks& blocks, const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  const std::size_t pairs = rings.edges.size() / 2;
  const auto inside = work.scratch().allocate<cl_uchar>(pairs);
  const auto found = work.scratch().allocate<cl_uchar>(pairs);
  const auto& account = rings.device_account;
  const auto& unsure = found;
  const bool with_quadrilaterals = tuning_of(runtime).blocks_in_parallel != 0;
  if (!with_quadrilaterals)
    runtime.map(pairs, kernels::find_inside{.bound = work.bounds.circle,
                                            .account = account,
                                            .points = blocks.vertices,
                                            .edges = rings.edges,
                                            .unsure = unsure});
  runtime.map(pairs, kernels::find_inside_exactly{.with_quadrilaterals = with_quadrilaterals,
                                                  .bound = work.bounds.circle,
                                                  .account = account,
                                                  .points = blocks.vertices,
                                                  .edges = rings.edges,
                                                  .unsure = unsure,
                                                  .inside = inside});
  runtime.map(pairs, kernels::find_fans{.account = account,
                                        .points = blocks.vertices,
                                        .edges = rings.edges,
                                        .inside = inside,
                                        .vertex_edge = rings.vertex_edge,
                                        .found = found});
  runtime.map(
      pairs, kernels::build_fans{.account = account, .inside = inside, .found = found, .edges = rings.edges});
}

void make_fans_of_blocks(Workspace& work, const Blocks& blocks, const Rings& rings) {
  Arena::Scope scope(work.scratch());
  const std::size_t pairs = rings.edges.size() / 2,
                    group = group_for(tuning_of(work.runtime), blocks.count, pairs);
  work.runtime.launch(group * blocks.count, group,
                      kernels::make_fans_of_blocks{.blocks = blocks.count,
                                                   .offsets = blocks.device_offsets,
                                                   .bound = work.bounds.circle,
                                                   .account = rings.device_account,
                                                   .points = blocks.vertices,
                                                   .edges = rings.edges,
                                                   .vertex_edge = rings.vertex_edge,
                                                   .inside = work.scratch().allocate<cl_uchar>(pairs),
                                                   .found = work.scratch().allocate<cl_uchar>(pairs)});
}

}  // namespace flaunay::blocks
