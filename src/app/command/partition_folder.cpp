#include "app/command/partition_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <string_view>
#include <system_error>

#include "app/command/json.hpp"
#include "app/command/options.hpp"
#include "app/files/mesh.hpp"
#include "app/files/npy.hpp"
#include "app/files/region.hpp"
#include "files/file.hpp"

namespace flaunay::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* kDescription = "partition.json";
constexpr const char* kFinished = "finished.npy";
constexpr std::string_view kRegionPrefix = "region-";

std::string inside(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).generic_string();
}

std::string region_stem(const std::string& folder, std::size_t r) {
  return inside(folder, fmt::format("{}{:05}", kRegionPrefix, r));
}

bool is_partition_name(const std::string& name) {
  return name == kDescription || name == kFinished || name.rfind(kRegionPrefix, 0) == 0;
}

std::vector<fs::path> partition_files(const std::string& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (is_partition_name(entry->path().filename().string())) files.push_back(entry->path());
  }
  if (error) io::fail(folder, "cannot be listed: {}", error.message());
  std::sort(files.begin(), files.end());
  return files;
}

// A file of the old partition may only be replaced if --force was given and it is neither the input nor a
// folder.
void check_in_the_way(const fs::path& file, const std::string& input, bool force) {
  std::error_code error;
  if (input != "-" && io::is_one_file(file.generic_string(), input)) {
    throw Error(ErrorKind::usage,
                fmt::format("{}: the partition would overwrite the input; choose another folder", input));
  }
  if (!force) {
    throw Error(ErrorKind::usage, fmt::format("{}: is in the way: the folder holds a partition; choose "
                                              "another, or replace it with --force",
                                              file.generic_string()));
  }
  if (fs::is_directory(file, error)) {
    throw Error(ErrorKind::usage, fmt::format("{}: is a folder, and in the way", file.generic_string()));
  }
}

std::string description(const research::Partition& partition, const PartitionFacts& facts) {
  Json json;
  json["flaunay"] = version();
  json["device"] = partition.statistics.device;
  json["input"] = facts.input;
  json["points"] = partition.statistics.points;
  json["duplicates"] = partition.statistics.duplicates;
  json["levels"] = facts.levels;
  json["cut"] = to_string(facts.cut);
  json["hull_variant"] = to_string(facts.dividing_paths);
  json["finished_triangles"] = partition.triangles.size() / 3;
  json["number_of_regions"] = partition.regions.size();
  json["regions"] = list_json(partition.regions, [](const research::Region& region) -> Json {
    return {{"points", region.points.size()}, {"border_edges", region.border.size() / 2}};
  });
  return text_of(json);
}

Json parse(const std::string& path) {
  const std::string text = io::read_file(path, "the description of a partition, as flaunay partition writes");
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    io::fail(path, "is no valid JSON (at byte {})", error.byte);
  }
}

// The value of a key that holds a number of things.
std::size_t count_of(const std::string& path, const Json& object, const char* key) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (found == object.end() || !found->is_number_unsigned() || found->get<std::uint64_t>() > kMost) {
    io::fail(path, "expected '{}' to be a number from 0 to {}", key, kMost);
  }
  return found->get<std::size_t>();
}

// Compares the region's points with those of the input, because the indices alone do not show that the input
// is another file.
void check_points(const std::string& path, const io::StoredRegion& stored, const std::string& input,
                  const io::Points& points) {
  for (std::size_t k = 0; k < stored.points.size(); ++k) {
    const auto index = static_cast<std::size_t>(stored.region.points[k]);
    if (index >= points.size()) {
      io::fail(path, "vertex {} is point {}, but {} has {}", k, index, input, points.size());
    }
    const double* here = &stored.points.coordinates[2 * k];
    const double* there = &points.coordinates[2 * index];
    if (here[0] != there[0] || here[1] != there[1]) {
      io::fail(path,
               "vertex {} is ({}, {}), but point {} of {} is ({}, {}): is the partition of other input?", k,
               here[0], here[1], index, input, there[0], there[1]);
    }
  }
}

}  // namespace

io::Temporary make_partition_folder(const std::string& folder, const std::string& input, bool force) {
  const io::Uninterrupted made;
  std::error_code error;
  const bool is_new = fs::create_directory(folder, error);
  if (error) io::fail(folder, "cannot be made: {}", error.message());
  for (const fs::path& file : partition_files(folder)) check_in_the_way(file, input, force);
  return is_new ? io::Temporary(folder) : io::Temporary();
}

void announce_partition(io::Outputs& outputs, const std::string& folder) {
  outputs.announce(inside(folder, kFinished));
  outputs.announce(inside(folder, kDescription));
}

void write_partition(io::Outputs& outputs, const std::string& folder, const io::Points& points,
                     const research::Partition& partition, const PartitionFacts& facts) {
  std::set<std::string> old;  // without those that are replaced
  for (const fs::path& file : partition_files(folder)) old.insert(file.generic_string());
  for (std::size_t r = 0; r < partition.regions.size(); ++r) {
    const std::string stem = region_stem(folder, r);
    io::write_region(outputs, stem, points, partition.regions[r]);
    outputs.close();
    for (const char* ending : {".node", ".poly"}) old.erase(stem + ending);
  }
  io::write_npy(outputs, inside(folder, kFinished), partition.triangles, 3);
  outputs.open(inside(folder, kDescription)).print("{}", description(partition, facts));
  for (const char* name : {kFinished, kDescription}) old.erase(inside(folder, name));
  for (const std::string& path : old) outputs.remove(path);
}

PartitionReader::PartitionReader(const std::string& folder) : folder_(folder) {
  const std::string path = description_path();
  const Json json = parse(path);
  input_points_ = count_of(path, json, "points");
  finished_triangles_ = count_of(path, json, "finished_triangles");
  const auto regions = json.find("regions");
  if (regions == json.end() || !regions->is_array()) io::fail(path, "expected 'regions' to be an array");
  for (const Json& region : *regions) {
    sizes_.push_back({count_of(path, region, "points"), count_of(path, region, "border_edges")});
  }
}

std::string PartitionReader::description_path() const { return inside(folder_, kDescription); }

std::string PartitionReader::stem(std::size_t r) const { return region_stem(folder_, r); }

std::string PartitionReader::solution_path(std::size_t r) const {
  for (const char* ending : {".npy", ".ele", ".1.ele"}) {
    std::error_code error;
    const std::string path = stem(r) + ending;
    if (fs::exists(path, error)) return path;
  }
  return "";
}

research::Partition PartitionReader::read(const std::string& input, const io::Points& points) const {
  if (points.size() != input_points_) {
    io::fail(input, "has {} points, but the partition in {} is of {}", points.size(), folder_, input_points_);
  }
  research::Partition partition;
  const std::string finished = inside(folder_, kFinished);
  partition.triangles = io::read_npy_triangles(finished);
  const std::size_t triangles = partition.triangles.size() / 3;
  if (triangles != finished_triangles_) {
    io::fail(finished, "has {} triangles; expected {}", triangles, finished_triangles_);
  }
  for (std::size_t r = 0; r < regions(); ++r) {
    const io::StoredRegion stored = io::read_region(stem(r), sizes_[r].points, sizes_[r].border_edges);
    check_points(stem(r) + ".node", stored, input, points);
    partition.regions.push_back(stored.region);
  }
  return partition;
}

void check_no_partition_file(const std::string& folder, const std::string& path) {
  if (path.empty()) return;
  const io::Target target = io::find_target(path);
  if (!io::is_one_file(target.folder, folder)) return;
  // A file may have the name of another one in different case.
  const std::vector<fs::path> files = partition_files(folder);
  const auto is_target = [&](const fs::path& file) {
    return io::is_one_file(file.generic_string(), target.path);
  };
  if (is_partition_name(fs::path(target.path).filename().string()) ||
      std::any_of(files.begin(), files.end(), is_target)) {
    throw Error(ErrorKind::usage, fmt::format("{}: this output would overwrite the partition", path));
  }
}

}  // namespace flaunay::cli
