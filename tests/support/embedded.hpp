// A triangulator in a context of the caller's, for all tests of a program.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "flaunay/flaunay.hpp"
#include "tests/support/embedder.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {

/// One context, and a triangulator in it, for all tests.
struct World {
  World() : embedder(triangulator().device_id()), in_context(embedder.context(), embedder.device()) {}
  Embedder embedder;
  Triangulator in_context;
};

class Worlds : public ::testing::Environment {
 public:
  static World& get() {
    if (!instance()) instance() = std::make_unique<World>();
    return *instance();
  }
  void TearDown() override { instance().reset(); }

 private:
  static std::unique_ptr<World>& instance() {
    static std::unique_ptr<World> world;
    return world;
  }
};
[[maybe_unused]] inline ::testing::Environment* const kWorlds =
    ::testing::AddGlobalTestEnvironment(new Worlds);

inline Embedder& embedder() { return Worlds::get().embedder; }
inline Triangulator& embedded() { return Worlds::get().in_context; }

}  // namespace flaunay::testing
