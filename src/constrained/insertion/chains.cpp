#include "constrained/insertion/chains.hpp"

#include <algorithm>
#include <utility>

#include "host/launch/vector_operations.hpp"
#include "launchers/constrained/chain_rounds.cl.hpp"
#include "launchers/constrained/chains.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::constrained {

namespace {

using host::Arena;
using host::Runtime;

// Scratch memory that kernels/constrained/chains.h needs for chains with `count` vertices.
struct Scratch {
  Buffer<cl_double2> places;
  Buffer<kernel::chain_vertex> vertices;
  Buffer<kernel::chain_edge> edges;

  Scratch(Arena& arena, std::size_t count)
      : places(arena.allocate<cl_double2>(count)),
        vertices(arena.allocate<kernel::chain_vertex>(count)),
        edges(arena.allocate<kernel::chain_edge>(3 * count)) {}
};

// Binary places of a number.
int bits_of(std::size_t number) {
  int bits = 0;
  for (; number > 0; number /= 2) ++bits;
  return bits;
}

// The long chains, one after the other: kernels/constrained/chain_rounds.cl.
class LongChains {
 public:
  LongChains(Runtime& runtime, const DeviceChains& all, std::size_t count, std::size_t vertices)
      : runtime_(runtime),
        all_(all),
        count_(count),
        vertices_(vertices),
        // A round removes about a third of the vertices.
        thinning_rounds_(2 * bits_of(vertices)),
        chains_(runtime.arena().allocate<cl_int>(count)),
        offsets_(runtime.arena().allocate<cl_int>(count + 1)),
        of_(runtime.arena().allocate<cl_int>(vertices)),
        scratch_(runtime.arena(), vertices),
        hubs_(runtime.arena().allocate<cl_uchar>(vertices)),
        stages_(runtime.arena().allocate<cl_uchar>(vertices)),
        roles_(runtime.arena().allocate<cl_uchar>(vertices)),
        lists_{runtime.arena().allocate<cl_int2>(vertices), runtime.arena().allocate<cl_int2>(vertices)},
        owners_{runtime.arena().allocate<cl_uint>(vertices), runtime.arena().allocate<cl_uint>(vertices)},
        state_(runtime.arena().allocate<cl_uint>(2)),
        wrong_(runtime.arena().allocate<cl_uint>(count)) {}

  // places: of the vertices of all chains; numbers: the scanned numbers of long chains and of their vertices.
  void start(const Buffer<cl_double2>& places, const Buffer<cl_uint2>& numbers) {
    runtime_.launch(all_.count + 1, runtime_.sizes().map_group, all_.count,
                    kernels::list_long_chains{.places = numbers, .chains = chains_, .offsets = offsets_});
    runtime_.map(vertices_, kernels::start_vertices{.count = count_,
                                                    .chains = chains_,
                                                    .offsets = offsets_,
                                                    .all = all_.offsets,
                                                    .all_places = places,
                                                    .of = of_,
                                                    .places = scratch_.places,
                                                    .hubs = hubs_});
  }

  // Removes the vertices and inserts them, from the beginning again if there are hubs.
  void triangulate(std::size_t longest_walk) {
    constexpr int kMostPasses = 8;
    for (int pass = 0;; ++pass) {
      thin(pass > 0);
      if (insert(pass, pass < kMostPasses ? longest_walk : vertices_)) return;
    }
  }

  void write(const Buffer<cl_int>& triangles) {
    runtime_.fill(wrong_, count_, cl_uint{0});
    runtime_.map_in_small_groups(
        vertices_, kernels::check_triangles{
                       .bound = all_.circle_bound, .worked_chains = worked_chains(), .wrong = wrong_});
    runtime_.map(vertices_, kernels::link_apexes{.worked_chains = worked_chains(), .jumps = lists_[0]});
    for (int k = bits_of(vertices_); k > 0; --k) {
      runtime_.map(vertices_, kernels::jump_apexes{.jumps = lists_[0], .result = lists_[1]});
      std::swap(lists_[0], lists_[1]);
    }
    runtime_.map_in_small_groups(vertices_, kernels::write_chain_rows{.bound = all_.circle_bound,
                                                                      .chains = chains_,
                                                                      .worked_chains = worked_chains(),
                                                                      .all = all_.offsets,
                                                                      .jumps = lists_[0],
                                                                      .wrong = wrong_,
                                                                      .triangles = triangles});
  }

 private:
  kernels::worked_chains worked_chains() const {
    return {.offsets = offsets_,
            .of = of_,
            .places = scratch_.places,
            .vertices = scratch_.vertices,
            .edges = scratch_.edges};
  }
  void thin(bool has_hubs) {
    runtime_.map(vertices_, kernels::start_lists{.offsets = offsets_,
                                                 .of = of_,
                                                 .vertices = scratch_.vertices,
                                                 .list = lists_[0],
                                                 .owners = owners_[0]});
    // Hubs and the vertices left beside them are few.
    const int without_hubs = thinning_rounds_, all = has_hubs ? 2 * without_hubs : without_hubs;
    for (int k = 0; k < all; ++k) {
      runtime_.map(vertices_, kernels::thin_chains{.round = k,
                                                   .stage = all - k,
                                                   .with_hubs = k >= without_hubs,
                                                   .offsets = offsets_,
                                                   .of = of_,
                                                   .places = scratch_.places,
                                                   .hubs = hubs_,
                                                   .list = lists_[0],
                                                   .thinned = lists_[1],
                                                   .vertices = scratch_.vertices,
                                                   .stages = stages_});
      std::swap(lists_[0], lists_[1]);
    }
    runtime_.launch(count_, tuning_of(runtime_).block_group, count_,
                    kernels::finish_thinning{.offsets = offsets_,
                                             .places = scratch_.places,
                                             .lists = lists_[0],
                                             .vertices = scratch_.vertices,
                                             .edges = scratch_.edges,
                                             .stages = stages_});
  }

  // Returns false if there are hubs. It takes a few rounds more than thinning, on hard chains twice as many;
  // waits to know whether these suffice.
  bool insert(int pass, std::size_t longest_walk) {
    runtime_.fill(state_, 2, cl_uint{0});
    const int between = std::max(1, thinning_rounds_ / 4);
    for (int round = 1;; ++round) {
      const bool counts = round > thinning_rounds_ && round % between == 0;
      insert_round(round, pass, longest_walk, counts);
      if (!counts) continue;
      cl_uint state[2];
      runtime_.read(state_, 0, 2, state);
      if (state[1] != 0) return false;
      if (state[0] == 0) return true;
      runtime_.fill(state_, 1, cl_uint{0});
    }
  }

  void insert_round(int round, int pass, std::size_t longest_walk, bool counts) {
    runtime_.map_in_small_groups(vertices_, kernels::claim_triangles{.round = round,
                                                                     .pass = pass,
                                                                     .longest_walk = longest_walk,
                                                                     .bound = all_.circle_bound,
                                                                     .worked_chains = worked_chains(),
                                                                     .stages = stages_,
                                                                     .hubs = hubs_,
                                                                     .owners = owners_[0],
                                                                     .roles = roles_,
                                                                     .state = state_});
    runtime_.map(vertices_, kernels::choose_vertices{.round = round,
                                                     .counts = counts,
                                                     .worked_chains = worked_chains(),
                                                     .stages = stages_,
                                                     .owners = owners_[0],
                                                     .next_owners = owners_[1],
                                                     .roles = roles_,
                                                     .state = state_});
    runtime_.map(vertices_, kernels::insert_vertices{.round = round,
                                                     .worked_chains = worked_chains(),
                                                     .stages = stages_,
                                                     .owners = owners_[0],
                                                     .roles = roles_});
    std::swap(owners_[0], owners_[1]);
  }

  Runtime& runtime_;
  const DeviceChains& all_;
  std::size_t count_, vertices_;
  int thinning_rounds_;
  Buffer<cl_int> chains_, offsets_, of_;
  Scratch scratch_;
  Buffer<cl_uchar> hubs_, stages_, roles_;
  Buffer<cl_int2> lists_[2];
  Buffer<cl_uint> owners_[2];
  Buffer<cl_uint> state_, wrong_;
};

// Waits for the number of long chains.
void triangulate_long(Runtime& runtime, const DeviceChains& chains, const Buffer<cl_double2>& places,
                      const Buffer<cl_int>& triangles) {
  const Tuning& tuning = tuning_of(runtime);
  const std::size_t least = std::max(tuning.chain_wrapped_most, tuning.chain_alone_most) + 1;
  const auto numbers = runtime.arena().allocate<cl_uint2>(chains.count + 1);
  runtime.map(chains.count,
              kernels::measure_long_chains{.least = least, .offsets = chains.offsets, .sizes = numbers});
  host::exclusive_scan(runtime, numbers, chains.count, numbers);
  const cl_uint2 total = runtime.read_one(numbers, chains.count);
  if (total.s[0] == 0) return;
  LongChains found(runtime, chains, total.s[0], total.s[1]);
  found.start(places, numbers);
  found.triangulate(tuning.chain_walk_most);
  found.write(triangles);
}

}  // namespace

void triangulate_chains(Runtime& runtime, const DeviceChains& chains, const Buffer<cl_int>& triangles) {
  if (chains.count == 0 || chains.vertices == 0) return;
  const Tuning& tuning = tuning_of(runtime);
  // Kernels that run natively are made for cores.
  const bool is_alone =
      runtime.is_native() || std::min(chains.longest, chains.vertices) <=
                                 std::max(tuning.chain_wrapped_most, tuning.chain_alone_most);
  const std::size_t alone_most =
      runtime.is_native() ? std::max(chains.vertices, tuning.chain_alone_most) : tuning.chain_alone_most;
  Arena::Scope scope(runtime.arena());
  const Scratch scratch(runtime.arena(), chains.vertices);
  runtime.map(chains.vertices, kernels::gather_vertices{.count = chains.count,
                                                        .offsets = chains.offsets,
                                                        .points = chains.points,
                                                        .chain = chains.chain,
                                                        .places = scratch.places});
  runtime.launch(chains.count, tuning.block_group, chains.count,
                 kernels::triangulate_chains{.wrapped_most = tuning.chain_wrapped_most,
                                             .alone_most = alone_most,
                                             .bound = chains.circle_bound,
                                             .offsets = chains.offsets,
                                             .places = scratch.places,
                                             .vertices = scratch.vertices,
                                             .edges = scratch.edges,
                                             .triangles = triangles});
  if (!is_alone) triangulate_long(runtime, chains, scratch.places, triangles);
}

}  // namespace flaunay::constrained
