// Meshes and contours as layers of features.
#include "app/files/layers.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/files/formats.hpp"
#include "app/files/geotiff.hpp"
#include "app/files/json_value.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

using Value = Layer::Value;

void print_value(OutputFile& file, const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    file.print("{}", *integer);
  } else if (const auto* number = std::get_if<double>(&value); number != nullptr && std::isfinite(*number)) {
    file.print("{}", *number);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    file.print("{}", nlohmann::json(*text).dump());
  } else {
    file.print("null");
  }
}

void write_geojson_layer(OutputFile& file, const Layer& layer) {
  file.print("{{\"type\":\"FeatureCollection\",{}\"features\":[", geojson_crs(layer.crs));
  std::vector<double> positions;
  for (std::size_t k = 0; k < layer.size; ++k) {
    file.print("{}\n{{\"type\":\"Feature\",\"properties\":{{", k == 0 ? "" : ",");
    for (std::size_t f = 0; f < layer.fields.size(); ++f) {
      file.print("{}{}:", f == 0 ? "" : ",", nlohmann::json(layer.fields[f].name).dump());
      print_value(file, layer.fields[f].value(k));
    }
    file.print("}},\"geometry\":{{\"type\":\"{}\",\"coordinates\":[",
               layer.is_polygons ? "Polygon" : "LineString");
    if (layer.is_polygons) file.print("[");
    positions.clear();
    layer.append(k, positions);
    for (std::size_t p = 0; p < positions.size(); p += 3)
      file.print("{}[{},{}]", p == 0 ? "" : ",", positions[p], positions[p + 1]);
    file.print("{}]}}}}", layer.is_polygons ? "]" : "");
  }
  file.print("\n]}}\n");
}

// The mean of known numbers at the corners of a triangle. values: as FieldValue or double.
template <typename Values>
Value mean(const MeshContents& contents, std::size_t triangle, const Values& values) {
  double sum = 0;
  int count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto corner = static_cast<std::size_t>(contents.corners(triangle)[k]);
    const double value = corner < values.size() ? number_of(values[corner]) : std::nan("");
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  if (count == 0) return {};
  return sum / count;
}

// The properties of polygons, by name, in their order.
std::vector<Layer::Field> properties_of(const MeshContents& contents) {
  using Ordered = nlohmann::ordered_json;
  const std::vector<std::int32_t>& polygons = contents.constraints().polygons;
  if (polygons.empty() || contents.map == nullptr) return {};
  std::vector<PointField> columns;  // of polygons, here
  const std::vector<std::string>& properties = contents.map->properties;
  for (std::size_t p = 0; p < properties.size(); ++p) {
    Ordered object = Ordered::parse("{" + properties[p] + "}");
    for (auto& [name, value] : object.items()) {
      const auto is_it = [&name = name](const PointField& column) { return column.name == name; };
      auto column = std::find_if(columns.begin(), columns.end(), is_it);
      if (column == columns.end())
        column = columns.insert(column, {name, std::vector<Value>(properties.size())});
      column->values[p] = field_value(value);
    }
  }
  std::vector<Layer::Field> fields;
  for (PointField& column : columns) {
    const Value type = common_type(column.values);
    fields.push_back({column.name, type, [&polygons, values = std::move(column.values)](std::size_t t) {
                        return polygons[t] < 0 ? Value() : values[static_cast<std::size_t>(polygons[t])];
                      }});
  }
  return fields;
}

// Fields of triangles: points, means, and what constraints say. Ours have longer names if others have theirs.
std::vector<Layer::Field> fields_of(const MeshContents& contents) {
  std::vector<Layer::Field> given = properties_of(contents), fields;
  for (const PointField& field : contents.points.fields) {
    const auto is_it = [&](const Layer::Field& other) { return other.name == field.name; };
    if (std::any_of(given.begin(), given.end(), is_it)) continue;  // polygons have it as it is
    given.push_back({field.name, 0.0, [&](std::size_t t) { return mean(contents, t, field.values); }});
  }
  const auto add = [&](const std::string& name, const Value& type, std::function<Value(std::size_t)> value) {
    fields.push_back({own_name(name, given), type, std::move(value)});
  };
  const auto add_labels = [&](const char* name, const std::vector<std::int32_t>& labels) {
    if (labels.empty()) return;
    add(name, std::int64_t{0}, [&labels](std::size_t t) { return std::int64_t{labels[t]}; });
  };
  constexpr const char* kCorners[] = {"point_a", "point_b", "point_c"};
  for (std::size_t k = 0; k < 3; ++k) {
    add(kCorners[k], std::int64_t{0},
        [&contents, k](std::size_t t) { return std::int64_t{contents.corners(t)[k]}; });
  }
  if (!contents.points.heights.empty())
    add("z", 0.0, [&contents](std::size_t t) { return mean(contents, t, contents.points.heights); });
  const ConstrainedTriangulation& constraints = contents.constraints();
  if (!constraints.constraint_edges.empty()) {
    add_labels("region", constraints.regions);
    add_labels("depth", constraints.depths);
  }
  add_labels("polygon", constraints.polygons);
  std::move(given.begin(), given.end(), std::back_inserter(fields));
  return fields;
}

void write_triangles(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  Layer layer;
  layer.name = "triangles";
  layer.is_polygons = true;
  layer.has_heights = !contents.points.heights.empty();
  layer.crs = contents.points.crs;
  layer.size = contents.triangle_count();
  layer.append = [&contents](std::size_t t, std::vector<double>& positions) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto corner = static_cast<std::size_t>(contents.corners(t)[k % 3]);
      const double* const at = &contents.points.coordinates[2 * corner];
      positions.insert(positions.end(), {at[0], at[1], contents.height(corner)});
    }
  };
  layer.fields = fields_of(contents);
  write_gdal_layer(outputs, path, layer);
}

constexpr Format layer_format(std::string_view ending) {
  return {.ending = ending,
          .map = read_layer,
          .write_layer = write_triangles,
          .has_labels = true,
          .is_spatial = true};
}

constexpr Format shapefile() {
  Format format = layer_format(".shp");
  format.sidecars = {".shx", ".dbf", ".prj", ".cpg", ".qix", ".sbn", ".sbx", ".idm", ".ind"};
  return format;
}

}  // namespace

const Format kGpkg = layer_format(".gpkg");
const Format kShp = shapefile();
const Format kFgb = layer_format(".fgb");
const Format kParquet = layer_format(".parquet");

FieldValue common_type(const std::vector<FieldValue>& values) {
  FieldValue type = std::int64_t{0};
  for (const FieldValue& value : values) {
    if (std::holds_alternative<std::string>(value)) return std::string();
    if (std::holds_alternative<double>(value)) type = 0.0;
  }
  return type;
}

std::string own_name(std::string name, const std::vector<Layer::Field>& given) {
  const auto is_it = [&](const Layer::Field& field) { return lower(field.name) == lower(name); };
  while (std::any_of(given.begin(), given.end(), is_it)) name = "flaunay_" + name;
  return name;
}

void write_layer(Outputs& outputs, const std::string& path, const Layer& layer) {
  if (ending_of(path) != ".geojson") return write_gdal_layer(outputs, path, layer);
  write_geojson_layer(outputs.open(path), layer);
  note_crs(outputs, path, layer.crs);
}

void write_lines(Outputs& outputs, const std::string& path, const Contours& contours,
                 const std::vector<double>& heights, const std::string& crs) {
  Layer layer;
  layer.name = "contours";
  layer.crs = crs;
  layer.size = contours.heights.size();
  layer.append = [&contours](std::size_t line, std::vector<double>& positions) {
    for (std::size_t p = contours.offsets[line]; p < contours.offsets[line + 1]; ++p)
      positions.insert(positions.end(), {contours.coordinates[2 * p], contours.coordinates[2 * p + 1], 0.0});
  };
  layer.fields = {{"height", 0.0, [&](std::size_t line) {
                     return heights[static_cast<std::size_t>(contours.heights[line])];
                   }}};
  write_layer(outputs, path, layer);
}

void choose_crs(const std::string& asked, const std::string& input, const std::string& output,
                std::string& crs) {
  if (!asked.empty()) {
    crs = crs_text(asked);
  } else if (find_format(output, Use::write_layer) != nullptr || ending_of(output).rfind(".tif", 0) == 0) {
    check_crs(crs, input);
  }
}

void check_same_crs(const std::string& path, const std::string& crs, const std::string& others,
                    const std::string& others_crs) {
  if (!are_different_crs(crs, others_crs)) return;
  fail(path,
       "has the coordinate system {}, but that of {} is {}: reproject one of them, or say by --crs what both "
       "have",
       crs, others, others_crs);
}

void note_crs(Outputs& outputs, const std::string& path, const std::string& crs) {
  if (crs.empty() || crs == kDegrees || epsg_code(crs) != 0) return;
  outputs.notes.push_back(
      fmt::format("{} has no coordinate system: GeoJSON names those of EPSG alone; .gpkg has all", path));
}

std::string geojson_crs(const std::string& crs) {
  const int code = crs.empty() || crs == kDegrees ? 0 : epsg_code(crs);
  if (code == 0) return "";
  return fmt::format(
      "\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":\"urn:ogc:def:crs:EPSG::{}\"}}}},", code);
}

}  // namespace flaunay::io
