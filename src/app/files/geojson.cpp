// GeoJSON (RFC 7946).
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "app/files/formats.hpp"
#include "app/files/geotiff.hpp"
#include "app/files/globe.hpp"
#include "app/files/json_value.hpp"
#include "app/files/layers.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

using Json = nlohmann::json;

/// The path of a value in the document, such as features[2].geometry. It becomes text only for a message.
class Place {
 public:
  Place() = default;
  Place(const Place& parent, const char* key) : parent_(&parent), key_(key) {}
  Place(const Place& parent, std::size_t index) : parent_(&parent), index_(index) {}

  std::string text() const {
    if (parent_ == nullptr) return "the document";
    const std::string before = parent_->parent_ == nullptr ? "" : parent_->text();
    if (key_ == nullptr) return fmt::format("{}[{}]", before, index_);
    return before.empty() ? key_ : before + "." + key_;
  }
  std::size_t depth() const { return parent_ == nullptr ? 0 : parent_->depth() + 1; }

 private:
  const Place* parent_ = nullptr;
  const char* key_ = nullptr;
  std::size_t index_ = 0;
};

/// "line 3, column 7" of the first place where the text has a number, which stands in quotes in the message.
std::string place_of_number(std::string_view text, std::string_view message) {
  const std::size_t begin = message.find('\'') + 1;
  const std::string_view number = message.substr(begin, message.rfind('\'') - begin);
  const std::string_view before = text.substr(0, text.find(number));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t line_end = before.rfind('\n');
  return fmt::format("line {}, column {}", line,
                     before.size() - (line_end == std::string_view::npos ? 0 : line_end + 1) + 1);
}

Json parse_json(const std::string& path, const std::string& text) {
  // The messages begin with the exception's name in brackets.
  const auto message_of = [](const Json::exception& error) {
    const std::string_view message = error.what();
    return message.substr(std::min(message.find("] ") + 2, message.size()));
  };
  try {
    return Json::parse(text);
  } catch (const Json::out_of_range& error) {
    const std::string_view message = message_of(error);
    fail(path, "{}: {}; expected finite numbers", place_of_number(text, message), message);
  } catch (const Json::exception& error) {
    fail(path, "is no valid JSON: {}", message_of(error));
  }
}

/// Reads any object. The polygons of a MultiPolygon are one with several outer rings. A ring's closing
/// position is no point of its own; otherwise each position is a point, in the order of the file. Throws
/// Error(input) that names the path in the document.
class GeoJsonReader {
 public:
  GeoJsonReader(const std::string& path, const Columns& columns) : path_(path), columns_(columns) {
    for (const auto* names : {&columns.heights, &columns.fields})
      for (const std::string& name : *names) fields_.push_back({name, {}});
  }

  Map read() {
    const Json document = parse_json(path_, read_file(path_, "GeoJSON"));
    read_object(document, Place());
    read_crs(document);
    choose_fields();
    map_.complete_heights(path_);
    if (unclosed_ > 0) {
      map_.points.notes.push_back(
          fmt::format("{}: {} not closed: the last position should be the first one again", path_,
                      unclosed_ == 1 ? "a ring is" : std::to_string(unclosed_) + " rings are"));
    }
    return std::move(map_);
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void fail_at(const Place& at, fmt::format_string<Arguments...> format,
                            Arguments&&... arguments) const {
    fail(path_, "{} {}", at.text(), fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  /// A value for messages. Nothing here may recurse into values: arrays may lie in each other to any depth,
  /// and the library's parser and destructor do not recurse, but its serializer does.
  static std::string shown(const Json& value) {
    if (value.is_object()) return "an object";
    const auto is_structured = [](const Json& element) { return element.is_structured(); };
    if (value.is_array() && (value.size() > 4 || std::any_of(value.begin(), value.end(), is_structured))) {
      return fmt::format("an array of {} value{}", value.size(), value.size() == 1 ? "" : "s");
    }
    const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    constexpr std::size_t kLongest = 60;
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
  }

  const Json& member(const Json& object, const char* key, const Place& at) const {
    const auto found = object.find(key);
    if (found == object.end()) fail_at(at, "has no member \"{}\"", key);
    return *found;
  }
  const Json& array(const Json& object, const char* key, const Place& at) const {
    const Json& value = member(object, key, at);
    check_array(value, Place(at, key));
    return value;
  }
  void check_array(const Json& value, const Place& at) const {
    if (!value.is_array()) fail_at(at, "is {}; expected an array", shown(value));
  }

  /// Calls `read` with each element of an array and its place.
  template <typename Read>
  void for_each(const Json& values, const Place& at, const Read& read) {
    check_array(values, at);
    for (std::size_t k = 0; k < values.size(); ++k) read(values[k], Place(at, k));
  }

  void read_object(const Json& object, const Place& at) {
    if (at.depth() > kDeepest) fail(path_, "has collections inside of collections, too deep to be meant");
    if (!object.is_object()) fail_at(at, "is {}; expected a GeoJSON object", shown(object));
    const Json& type = member(object, "type", at);
    const auto read_this = [this](const Json& value, const Place& place) { read_object(value, place); };
    if (type == "FeatureCollection") {
      for_each(array(object, "features", at), Place(at, "features"), read_this);
    } else if (type == "Feature") {
      const Json& geometry = member(object, "geometry", at);
      if (!geometry.is_null()) read_object(geometry, Place(at, "geometry"));
      take_properties(object, at);
      if (!fields_.empty()) take_fields(object, Place(at, "properties"));
    } else if (type == "GeometryCollection") {
      for_each(array(object, "geometries", at), Place(at, "geometries"), read_this);
    } else {
      read_geometry(type, object, at);
    }
  }

  // Gives the polygons that have none yet the properties of their feature.
  void take_properties(const Json& feature, const Place& at) {
    const std::size_t first = map_.properties.size();
    map_.properties.resize(map_.polygon_count());
    const auto properties = feature.find("properties");
    if (first == map_.polygon_count() || properties == feature.end() || !properties->is_object()) return;
    check_depth(*properties, Place(at, "properties"));
    const std::string text = properties->dump();
    std::fill(map_.properties.begin() + static_cast<std::ptrdiff_t>(first), map_.properties.end(),
              text.substr(1, text.size() - 2));
  }

  // Appends the fields of a feature that are asked for, once for each of its points.
  void take_fields(const Json& feature, const Place& at) {
    static const Json kNone = Json::object();
    const auto found = feature.find("properties");
    const Json& properties = found != feature.end() && found->is_object() ? *found : kNone;
    for (const auto& property : properties.items()) {
      std::vector<std::string>& names = map_.field_names;
      if (std::find(names.begin(), names.end(), property.key()) == names.end())
        names.push_back(property.key());
    }
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      const auto value = properties.find(fields_[k].name);
      const bool is_known = value != properties.end() && !value->is_null();
      const Place place(at, fields_[k].name.c_str());
      if (is_known && k < columns_.heights.size() && !value->is_number())
        fail_at(place, "is {}; expected a number", shown(*value));
      if (is_known) check_depth(*value, place);
      fields_[k].values.resize(map_.points.size(), is_known ? field_value(*value) : FieldValue());
    }
  }

  // The height is the first field that a feature has.
  void choose_fields() {
    const auto is_there = [&](const PointField& field) {
      const std::vector<std::string>& names = map_.field_names;
      return std::find(names.begin(), names.end(), field.name) != names.end();
    };
    const auto kept = fields_.begin() + static_cast<std::ptrdiff_t>(columns_.heights.size());
    const auto height = std::find_if(fields_.begin(), kept, is_there);
    map_.has_height_field = height != kept;
    if (map_.has_height_field) {
      map_.points.heights.clear();
      for (const FieldValue& value : height->values) map_.points.heights.push_back(number_of(value));
    }
    const auto missing = std::find_if_not(kept, fields_.end(), is_there);
    if (missing != fields_.end()) fail(path_, "has no field '{}'; {}", missing->name, map_.known_fields());
    map_.points.fields.assign(kept, fields_.end());
  }

  // Level by level, since the serializer recurses.
  void check_depth(const Json& value, const Place& at) const {
    std::vector<const Json*> level = {&value}, next;
    for (std::size_t depth = 0; !level.empty(); ++depth, level.swap(next)) {
      if (depth > kDeepest) fail_at(at, "has values inside of values, too deep to be meant");
      next.clear();
      for (const Json* outer : level) {
        for (const Json& inner : *outer) {
          if (inner.is_structured()) next.push_back(&inner);
        }
      }
    }
  }

  // The member of the standard of 2008 that programs still write: {"properties": {"name": ...}}.
  void read_crs(const Json& document) {
    const auto member_of = [](const Json& object, const char* key) -> const Json& {
      static const Json kNone;
      const auto found = object.find(key);
      return object.is_object() && found != object.end() ? *found : kNone;
    };
    const Json& name = member_of(member_of(member_of(document, "crs"), "properties"), "name");
    if (!name.is_string()) return;
    map_.points.crs = name.get<std::string>();
    constexpr std::string_view kEpsg = "urn:ogc:def:crs:EPSG:";
    std::string& crs = map_.points.crs;
    if (crs.rfind(kEpsg, 0) == 0) crs = "EPSG:" + crs.substr(crs.rfind(':') + 1);
    if (crs.ends_with(":CRS84")) crs = kDegrees;  // urn:ogc:def:crs:OGC:1.3:CRS84
  }

  void read_geometry(const Json& type, const Json& object, const Place& at) {
    const auto rings = [this](const Json& value, const Place& place) { read_rings(value, place); };
    const auto line = [this](const Json& value, const Place& place) { read_line(value, place); };
    const auto point = [this](const Json& value, const Place& place) { read_point(value, place); };
    const Place coordinates(at, "coordinates");
    const auto one = [&](const auto& read) { read(array(object, "coordinates", at), coordinates); };
    const auto several = [&](const auto& read) {
      for_each(array(object, "coordinates", at), coordinates, read);
    };
    if (type == "Polygon" || type == "MultiPolygon") {
      type == "Polygon" ? one(rings) : several(rings);
      return map_.polygon_offsets.push_back(map_.ring_offsets.size() - 1);
    }
    map_.has_others = true;
    if (type == "LineString") return one(line);
    if (type == "MultiLineString") return several(line);
    if (type == "Point") return one(point);
    if (type == "MultiPoint") return several(point);
    fail_at(Place(at, "type"), "is {}; expected a type of GeoJSON, such as \"Polygon\"", shown(type));
  }

  void read_position(const Json& value, const Place& at) {
    if (!value.is_array() || value.size() < 2 || !value[0].is_number() || !value[1].is_number()) {
      fail_at(at, "is {}; expected a position [x, y]", shown(value));
    }
    if (map_.points.size() == static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      fail(path_, "has more than {} positions", std::numeric_limits<std::int32_t>::max());
    }
    for (int axis = 0; axis < 2; ++axis) map_.points.coordinates.push_back(value[axis].get<double>());
    const bool has_height = value.size() > 2 && value[2].is_number();
    map_.points.heights.push_back(has_height ? value[2].get<double>()
                                             : std::numeric_limits<double>::quiet_NaN());
  }
  /// Returns the index of the first point.
  std::size_t read_positions(const Json& values, const Place& at) {
    const std::size_t first = map_.points.size();
    for_each(values, at, [this](const Json& value, const Place& place) { read_position(value, place); });
    return first;
  }

  void read_point(const Json& value, const Place& at) {
    if (!value.empty()) read_position(value, at);  // an empty array is a geometry without a place
  }

  void read_line(const Json& value, const Place& at) {
    const std::size_t first = read_positions(value, at);
    if (map_.points.size() - first == 1) fail_at(at, "has one position; expected at least 2");
    map_.add_line(first);
  }

  /// Reads the rings of a polygon: first its border, then its holes.
  void read_rings(const Json& value, const Place& at) {
    for_each(value, at, [this](const Json& ring, const Place& place) { read_ring(ring, place); });
    map_.part_offsets.push_back(map_.ring_offsets.size() - 1);
  }

  void read_ring(const Json& value, const Place& at) {
    const std::size_t first = read_positions(value, at);
    const bool is_closed = map_.add_ring(first);
    if (!is_closed) ++unclosed_;
    if (map_.points.size() - first < 3) {
      fail_at(at, "is a ring of {} positions{}; expected at least 4, the last one equal to the first",
              value.size(), is_closed || value.empty() ? "" : " that is not closed");
    }
  }

  static constexpr std::size_t kDeepest = 100;

  const std::string& path_;
  const Columns& columns_;
  std::vector<PointField> fields_;  // those that may have heights, and those that points keep
  Map map_;
  std::size_t unclosed_ = 0;  // rings
};

/// Whether coordinates may be longitudes and latitudes.
bool are_degrees(const Points& points) {
  constexpr double kMost[] = {360, 90};
  for (std::size_t i = 0; i < points.coordinates.size(); ++i) {
    if (std::fabs(points.coordinates[i]) > kMost[i % 2]) return false;
  }
  return points.size() > 0;
}

Map read_geojson(const std::string& path, const Columns& columns) {
  Map map = GeoJsonReader(path, columns).read();
  std::string& crs = map.points.crs;
  // As RFC 7946 has it, unless coordinates are none.
  if (crs.empty() && are_degrees(map.points)) crs = kDegrees;
  return map;
}

/// The rest of the feature of a triangle on the globe.
void print_on_globe(OutputFile& file, const MeshContents& contents, std::size_t t) {
  GlobeRing ring;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto corner = static_cast<std::size_t>(contents.corners(t)[k]);
    ring.push_back({contents.points.coordinates[2 * corner], contents.points.coordinates[2 * corner + 1]});
  }
  file.print("\"geometry\":{{\"type\":\"MultiPolygon\",\"coordinates\":[");
  const std::vector<GlobeRing> parts = cut_at_date_line(ring);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    file.print("{}[[", p == 0 ? "" : ",");
    for (std::size_t k = 0; k <= parts[p].size(); ++k) {
      const OnGlobe& at = parts[p][k % parts[p].size()];
      file.print("{}[{},{}]", k == 0 ? "" : ",", at[0], at[1]);
    }
    file.print("]]");
  }
  file.print("]}}}}");
}

/// A feature per triangle, with its corners as a ring. It has the properties of its polygon, and its own
/// ones, which have a longer name if a polygon has such a property.
void write_geojson(OutputFile& file, const MeshContents& contents) {
  const ConstrainedTriangulation& constraints = contents.constraints();
  static const std::vector<std::string> kNone;
  const std::vector<std::string>& properties =
      contents.map == nullptr || constraints.polygons.empty() ? kNone : contents.map->properties;
  const auto name_of = [&](const std::string& name) {
    const std::string key = fmt::format("\"{}\":", name);
    const auto has_it = [&](const std::string& text) { return text.find(key) != std::string::npos; };
    return std::any_of(properties.begin(), properties.end(), has_it) ? fmt::format("\"flaunay_{}\":", name)
                                                                     : key;
  };
  const std::string triangle = name_of("triangle"), region = name_of("region"), depth = name_of("depth"),
                    polygon = name_of("polygon");
  file.print("{{\"type\":\"FeatureCollection\",{}\"features\":[", geojson_crs(contents.points.crs));
  for (std::size_t t = 0; t < contents.triangle_count(); ++t) {
    file.print("{}\n{{\"type\":\"Feature\",\"properties\":{{{}{}", t == 0 ? "" : ",", triangle, t);
    if (contents.has_labels()) {
      file.print(",{}{},{}{}", region, constraints.regions[t], depth, constraints.depths[t]);
    }
    if (!constraints.polygons.empty()) file.print(",{}{}", polygon, constraints.polygons[t]);
    const auto owner =
        constraints.polygons.empty() ? properties.size() : static_cast<std::size_t>(constraints.polygons[t]);
    if (owner < properties.size() && !properties[owner].empty()) file.print(",{}", properties[owner]);
    if (contents.is_on_globe) {
      file.print("}},");
      print_on_globe(file, contents, t);
      continue;
    }
    file.print("}},\"geometry\":{{\"type\":\"Polygon\",\"coordinates\":[[");
    for (std::size_t k = 0; k < 4; ++k) {
      const auto corner = static_cast<std::size_t>(contents.corners(t)[k % 3]);
      file.print("{}[{},{}", k == 0 ? "" : ",", contents.points.coordinates[2 * corner],
                 contents.points.coordinates[2 * corner + 1]);
      if (!contents.points.heights.empty()) file.print(",{}", contents.height(corner));
      file.print("]");
    }
    file.print("]]}}}}");
  }
  file.print("\n]}}\n");
}

}  // namespace

const Format kGeoJson = {.ending = ".geojson",
                         .map = read_geojson,
                         .write_mesh = write_geojson,
                         .has_labels = true,
                         .is_spatial = true};
const Format kJson = {.ending = ".json", .map = read_geojson};

}  // namespace flaunay::io
