#include "app/files/scan.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/files/las.hpp"
#include "app/files/line_pieces.hpp"
#include "app/files/map.hpp"
#include "app/files/npy.hpp"
#include "files/file.hpp"
#include "files/scratch.hpp"

namespace flaunay::io {
namespace {

constexpr std::size_t kTriple = 3 * sizeof(double);
// Records that are read at once.
constexpr std::size_t kPiece = std::size_t{1} << 15;
// Chosen points are counted by blocks of this many records, so that any chosen point can be found.
constexpr std::size_t kCountedBlock = std::size_t{1} << 12;

constexpr std::string_view kEndings = ".las, .npy, .txt, .xyz, .csv";
constexpr std::string_view kMaps = ", .geojson, .gpkg, .shp, .fgb, .parquet";

bool is_text(const std::string& ending) { return ending == ".txt" || ending == ".xyz" || ending == ".csv"; }

Box nothing() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {kInfinity, kInfinity, -kInfinity, -kInfinity};
}

void widen(Box& box, const Box& other) {
  for (std::size_t k = 0; k < 2; ++k) {
    box[k] = std::min(box[k], other[k]);
    box[k + 2] = std::max(box[k + 2], other[k + 2]);
  }
}

}  // namespace

/// The points of a file.
class Scan::Part {
 public:
  Part(std::string path, const ScanChoice& choice, const std::string& scratch, const Columns& columns,
       std::string_view third)
      : path_(std::move(path)), ending_(ending_of(path_)) {
    check_columns(path_, columns);
    if (is_text(ending_)) {
      read_text(scratch, columns, third);
    } else if (ending_ == ".las") {
      InputFile file(path_, "an uncompressed LAS file");
      file.first(1);  // throws if the file cannot be read
      las_ = read_las_header(path_, file);
      size_ = las_->size;
      record_bytes_ = las_->record_bytes;
      begin_ = las_->begin;
      if (size_ > 0) box_ = las_->box;
      is_filtered_ = true;
      return;
    } else if (ending_ == ".npy") {
      InputFile file(path_, "a NumPy array of shape (n, 3)");
      file.first(1);
      const PointRecords records = npy_triples(path_, file, columns);
      size_ = records.size;
      record_bytes_ = records.bytes;
      begin_ = records.begin;
      decode_ = records.decode;
    } else if (has_fields(path_) && third == "height") {
      read_places(scratch, columns);
    } else if (ending_ == ".laz") {
      fail(path_,
           "is compressed (LAZ), which this command does not read: decompress it first, for example with "
           "\"pdal translate IN.laz OUT.las\", or take flaunay.terrain in Python (pip install "
           "flaunay[terrain])");
    } else {
      fail_ending(path_, std::string(kEndings).append(third == "height" ? kMaps : ""));
    }
    if (!choice.takes_all())
      throw Error(ErrorKind::usage,
                  printable(fmt::format("{}: classes and returns are those of .las files alone", path_)));
  }

  const std::string& path() const { return path_; }
  const Box& box() const { return box_; }
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }
  std::string crs() const { return las_ ? las_->crs : crs_; }
  bool has_height_field() const { return has_height_field_; }
  std::uint64_t records() const { return size_; }
  const LeftOut& left_out() const { return left_out_; }
  void close() { file_.reset(); }

  /// Finds which points are chosen, which are numbered from `first` on. Returns the number of the one after
  /// them.
  std::uint64_t survey(std::uint64_t first, const ScanChoice& choice,
                       const std::function<void(std::uint64_t records)>& done) {
    first_ = first;
    box_ = nothing();
    seen_ = {};
    std::uint64_t chosen = 0;
    std::vector<double> triples;
    for (std::uint64_t at = 0; at < size_; at += kCountedBlock) {
      if (is_filtered_) chosen_before_.push_back(chosen);
      if (at % kPiece == 0) done(at);
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kCountedBlock, size_ - at));
      triples.clear();
      append(at, count, choice, triples);
      chosen += triples.size() / 3;
      check_finite(triples, at);
    }
    count_ = chosen;
    is_filtered_ = count_ < size_;
    left_out_ = seen_;
    return first_ + count_;
  }

  std::uint64_t first() const { return first_; }
  std::uint64_t end() const { return first_ + count_; }

  /// Appends the chosen points [begin, end), counted in the whole set.
  void read(std::uint64_t begin, std::uint64_t end, const ScanChoice& choice, std::vector<double>& triples) {
    begin -= first_;
    end -= first_;
    if (!is_filtered_) return append(begin, static_cast<std::size_t>(end - begin), choice, triples);
    auto block = static_cast<std::size_t>(
        std::upper_bound(chosen_before_.begin(), chosen_before_.end(), begin) - chosen_before_.begin() - 1);
    std::vector<double> found;
    for (; begin < end; ++block) {
      found.clear();
      const std::uint64_t at = std::uint64_t{block} * kCountedBlock;
      append(at, static_cast<std::size_t>(std::min<std::uint64_t>(kCountedBlock, size_ - at)), choice, found);
      const auto skipped = static_cast<std::size_t>(begin - chosen_before_[block]);
      const std::size_t taken = std::min(found.size() / 3 - skipped, static_cast<std::size_t>(end - begin));
      const auto from = found.begin() + static_cast<std::ptrdiff_t>(3 * skipped);
      triples.insert(triples.end(), from, from + static_cast<std::ptrdiff_t>(3 * taken));
      begin += taken;
    }
  }

 private:
  void read_text(const std::string& scratch, const Columns& columns, std::string_view third) {
    scratch_ = std::make_unique<ScratchFile>(scratch);
    LinePieces pieces(path_, "three numbers a line");
    const std::unique_ptr<PointText> parser = column_text(path_, columns, third);
    std::vector<double> places, thirds, triples;
    for (std::string_view lines; pieces.next(lines);) {
      places.clear();
      thirds.clear();
      triples.clear();
      parser->parse(lines, places, &thirds);
      for (std::size_t i = 0; i < thirds.size(); ++i)
        triples.insert(triples.end(), {places[2 * i], places[2 * i + 1], thirds[i]});
      scratch_->append(triples.data(), triples.size() * sizeof(double));
      size_ += triples.size() / 3;
    }
    record_bytes_ = kTriple;
  }

  // The positions of points and lines.
  void read_places(const std::string& scratch, const Columns& columns) {
    const Map map = read_map(path_, columns);
    if (map.polygon_count() > 0) {
      fail(path_,
           "has polygons; expected points or lines with heights; --flat and --boundary are for polygons");
    }
    std::vector<double> triples;
    for (std::size_t i = 0; i < map.points.size(); ++i) {
      const double* const at = &map.points.coordinates[2 * i];
      const double height = map.points.heights.empty() ? std::nan("") : map.points.heights[i];
      if (std::isnan(height)) {
        map.check_height_field(path_, columns.heights);
        fail(path_, "position {}, ({}, {}), has no height; --height says which field has it", i, at[0],
             at[1]);
      }
      triples.insert(triples.end(), {at[0], at[1], height});
    }
    scratch_ = std::make_unique<ScratchFile>(scratch);
    scratch_->append(triples.data(), triples.size() * sizeof(double));
    size_ = map.points.size();
    record_bytes_ = kTriple;
    crs_ = map.points.crs;
    has_height_field_ = map.has_height_field;
  }

  // Appends the chosen points among some records.
  void append(std::uint64_t first, std::size_t count, const ScanChoice& choice,
              std::vector<double>& triples) {
    for (std::size_t done = 0; done < count; done += kPiece) {
      const std::size_t piece = std::min(count - done, kPiece);
      records_.resize(piece * record_bytes_);
      const std::uint64_t place = begin_ + (first + done) * record_bytes_;
      if (scratch_) {
        scratch_->read_at(place, records_.size(), records_.data());
      } else {
        if (!file_) file_ = std::make_unique<InputFile>(path_, kEndings);
        file_->read_at(place, records_.size(), records_.data());
      }
      const std::size_t kept = is_filtered_ ? keep_chosen(piece, choice) : piece, at = triples.size();
      triples.resize(at + 3 * kept);
      if (las_) {
        las_->decode<3>(records_.data(), kept, triples.data() + at);
      } else if (decode_) {
        decode_(records_.data(), kept, triples.data() + at);
      } else {
        std::memcpy(triples.data() + at, records_.data(), kept * kTriple);
      }
    }
  }

  // Moves the chosen records to the front. Returns how many they are.
  std::size_t keep_chosen(std::size_t count, const ScanChoice& choice) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const char* const record = records_.data() + i * record_bytes_;
      if (!is_chosen(record, choice)) continue;
      if (kept < i) std::memmove(records_.data() + kept * record_bytes_, record, record_bytes_);
      ++kept;
    }
    return kept;
  }

  bool is_chosen(const char* record, const ScanChoice& choice) {
    using Returns = ScanChoice::Returns;
    constexpr int kLowNoise = 7, kHighNoise = 18;
    const int number = las_->return_number(record), class_of = las_->class_of(record);
    if (las_->is_withheld(record)) {
      ++seen_.withheld;
      return false;
    }
    if (choice.classes.none() && (class_of == kLowNoise || class_of == kHighNoise)) {
      ++seen_.noise;
      return false;
    }
    return (choice.classes.none() || choice.classes[static_cast<std::size_t>(class_of)]) &&
           (choice.returns == Returns::all ||
            number == (choice.returns == Returns::first ? 1 : las_->returns(record)));
  }

  void check_finite(const std::vector<double>& triples, std::uint64_t first) {
    Box box = nothing();
    double sum = 0;  // not finite if one of them is not
    for (std::size_t i = 0; i < triples.size(); i += 3) {
      const double x = triples[i], y = triples[i + 1], z = triples[i + 2];
      widen(box, {x, y, x, y});
      lowest_ = std::min(lowest_, z);
      highest_ = std::max(highest_, z);
      sum += 0 * x + 0 * y + 0 * z;
    }
    if (sum != 0) {
      fail(path_, "has a point whose coordinates or height are not finite, among the {} from point {} on",
           triples.size() / 3, first);
    }
    widen(box_, box);
  }

  std::string path_, ending_, crs_;
  bool has_height_field_ = false;
  std::optional<LasHeader> las_;
  std::unique_ptr<ScratchFile> scratch_;  // of text
  std::function<void(const char*, std::size_t, double*)> decode_;
  std::uint64_t size_ = 0, begin_ = 0;  // of the records
  std::size_t record_bytes_ = 0;
  Box box_ = nothing();
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_;
  bool is_filtered_ = false;
  LeftOut seen_, left_out_;  // in all passes and in the survey
  std::uint64_t first_ = 0, count_ = 0;
  std::vector<std::uint64_t> chosen_before_;  // by block
  std::unique_ptr<InputFile> file_;
  std::vector<char> records_;
};

Scan::Scan(const std::vector<std::string>& paths, const ScanChoice& choice, const std::string& scratch,
           const Columns& columns, std::string_view third)
    : choice_(choice) {
  for (const std::string& path : paths)
    parts_.push_back(std::make_unique<Part>(path, choice, scratch, columns, third));
}

Scan::~Scan() = default;

Box Scan::announced_box() const {
  Box box = nothing();
  for (const auto& part : parts_) widen(box, part->box());
  return box;
}

bool Scan::has_height_field() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->has_height_field(); });
}

LeftOut Scan::left_out() const {
  LeftOut sum;
  for (const auto& part : parts_) {
    sum.withheld += part->left_out().withheld;
    sum.noise += part->left_out().noise;
  }
  return sum;
}

std::array<double, 2> Scan::heights() const {
  std::array<double, 2> heights = {nothing()[0], nothing()[2]};
  for (const auto& part : parts_) {
    heights = {std::min(heights[0], part->lowest()), std::max(heights[1], part->highest())};
  }
  return heights;
}

std::vector<Scan::System> Scan::systems() const {
  std::vector<System> systems;
  for (const auto& part : parts_) {
    const std::string crs = part->crs();
    const auto is_it = [&](const System& system) { return system.crs == crs; };
    if (!crs.empty() && std::none_of(systems.begin(), systems.end(), is_it))
      systems.push_back({crs, part->path()});
  }
  return systems;
}

Box Scan::survey(const std::function<void(double done)>& progress) {
  std::uint64_t records = 0, before = 0;
  for (const auto& part : parts_) records += part->records();
  Box box = nothing();
  size_ = 0;
  for (const auto& part : parts_) {
    size_ = part->survey(size_, choice_, [&](std::uint64_t done) {
      progress(static_cast<double>(before + done) / static_cast<double>(records));
    });
    part->close();
    before += part->records();
    widen(box, part->box());
  }
  return box;
}

void Scan::read_triples(std::uint64_t first, std::size_t count) {
  triples_.clear();
  triples_first_ = first;
  const std::uint64_t end = first + count;
  const auto ends_later = [](std::uint64_t place, const auto& part) { return place < part->end(); };
  for (auto part = std::upper_bound(parts_.begin(), parts_.end(), first, ends_later);
       part != parts_.end() && (*part)->first() < end; ++part) {
    const std::uint64_t begin = std::max(first, (*part)->first()), stop = std::min(end, (*part)->end());
    if (begin < stop) (*part)->read(begin, stop, choice_, triples_);
    if (stop == (*part)->end()) (*part)->close();
  }
}

void Scan::read(std::uint64_t first, std::size_t count, double* coordinates) {
  read_triples(first, count);
  for (std::size_t i = 0; i < count; ++i) {
    coordinates[2 * i] = triples_[3 * i];
    coordinates[2 * i + 1] = triples_[3 * i + 1];
  }
}

void Scan::read_values(std::uint64_t first, std::size_t count, double* values) {
  if (first != triples_first_ || 3 * count != triples_.size()) read_triples(first, count);
  for (std::size_t i = 0; i < count; ++i) values[i] = triples_[3 * i + 2];
}

std::vector<std::string> scan_files(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    const std::optional<system::FileStatus> status = system::status_of(path);
    if (!status || status->kind != system::FileKind::folder) {
      if (!status && ending_of(path).empty()) fail(path, "is no file and no folder");
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(path, error), end; !error && entry != end;
         entry.increment(error)) {
      const std::string name = entry->path().string(), ending = ending_of(name);
      if (is_text(ending) || ending == ".las" || ending == ".laz" || ending == ".npy") found.push_back(name);
    }
    if (error) fail(path, "cannot be read: {}", error.message());
    if (found.empty()) fail(path, "has no files that end with {}, which are read of folders", kEndings);
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

}  // namespace flaunay::io
