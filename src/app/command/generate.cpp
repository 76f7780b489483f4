#include "app/files/generate.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/command/commands.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/files/formats.hpp"
#include "app/files/points.hpp"
#include "files/disk_space.hpp"
#include "files/file.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

namespace {

struct GenerateRequest {
  std::string distribution;
  std::size_t count = 0;
  std::uint64_t seed = 1;
  std::string output;
};

int generate(const GenerateRequest& request) {
  OutputFiles outputs;
  outputs.add_points(request.output);
  io::check_disk_space({{request.output, io::least_bytes(request.output, request.count)}});
  io::PointWriter writer(outputs, request.output, request.count);
  io::generate(request.distribution, request.count, request.seed,
               [&writer](const double* coordinates, std::size_t count) { writer.write(coordinates, count); });
  outputs.commit();
  return kSuccess;
}

std::string distribution_table() {
  std::vector<std::vector<std::string>> rows;
  for (const io::Distribution& distribution : io::distributions()) {
    rows.push_back({"  " + distribution.name, distribution.description});
  }
  return "Distributions:\n" + aligned(rows);
}

}  // namespace

void add_generate(CLI::App& app, Action& action) {
  auto request = std::make_shared<GenerateRequest>();
  CLI::App* command = app.add_subcommand("generate", "Write points of a known distribution");
  command->add_option("distribution", request->distribution, "One of those listed below")->required();
  // CLI11 itself would turn negative numbers into large ones and cap numbers that are too large.
  const CLI::Validator whole_number(
      [](std::string& text) -> std::string {
        constexpr std::size_t kMostDigits = std::numeric_limits<std::uint64_t>::digits10;
        const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
        if (digits && !text.empty() && text.size() <= kMostDigits) return "";
        return fmt::format("expected a whole number of at most {} digits, not '{}'", kMostDigits, text);
      },
      "");
  command->add_option("count", request->count, "How many points")->required()->check(whole_number);
  command
      ->add_option("--seed", request->seed,
                   "Seed of the random numbers; the same seed gives the same points on every machine")
      ->check(whole_number)
      ->capture_default_str();
  command
      ->add_option(
          "-o,--output", request->output,
          fmt::format("Points: {}, or - for text on standard output", io::endings_for(io::Use::write_points)))
      ->required();
  command->footer(
      examples({"flaunay generate kuzmin 1000000 --seed 1 -o points.npy", "flaunay generate grid 100 -o -"}) +
      "\n" + distribution_table());
  command->callback([request, &action] { action = [request] { return generate(*request); }; });
}

}  // namespace flaunay::cli
