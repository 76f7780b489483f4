// Layers of features by GDAL.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/files/formats.hpp"
#include "app/files/gdal.hpp"
#include "app/files/geotiff.hpp"
#include "app/files/layers.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Driver {
  std::string_view ending;
  const char* name;
};
constexpr Driver kDrivers[] = {
    {".gpkg", "GPKG"}, {".shp", "ESRI Shapefile"}, {".fgb", "FlatGeobuf"}, {".parquet", "Parquet"}};

// The name of the driver; empty for other files than layers. Throws Error(input) if GDAL does not have it.
std::string driver_of(const std::string& path) {
  const std::string ending = ending_of(path);
  for (const Driver& driver : kDrivers) {
    if (driver.ending != ending) continue;
    gdal_driver(driver.name, path);
    return driver.name;
  }
  gdal();
  return "";
}

struct DestroyFeature {
  void operator()(OGRFeatureH feature) const { gdal().OGR_F_Destroy(feature); }
};
using Feature = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, DestroyFeature>;
struct DestroyGeometry {
  void operator()(OGRGeometryH geometry) const { gdal().OGR_G_DestroyGeometry(geometry); }
};
using Geometry = std::unique_ptr<std::remove_pointer_t<OGRGeometryH>, DestroyGeometry>;

class LayerReader {
 public:
  LayerReader(const std::string& path, const Columns& columns)
      : path_(path), file_(without_layer(path)), columns_(columns) {}

  Map read() {
    const std::string driver = driver_of(file_);
    const char* const drivers[] = {driver.c_str(), nullptr};
    InputFile(file_, "a layer of features").first(1);  // throws with the system's reason
    const Dataset data(
        gdal().GDALOpenEx(file_.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers, nullptr, nullptr));
    if (!data) fail(file_, "cannot be read: {}", quiet_.reason());
    const OGRLayerH layer = choose_layer(data.get());
    read_names(gdal().OGR_L_GetLayerDefn(layer));
    map_.points.crs = text_of(gdal().OGR_L_GetSpatialRef(layer));
    quiet_.forget();
    GIntBig count = 0;
    for (; const Feature feature{gdal().OGR_L_GetNextFeature(layer)}; ++count) read_feature(feature.get());
    if (quiet_.has_failed()) fail(file_, "layer '{}': {}", name_, quiet_.reason());
    // In a Shapefile, deleted ones count, too.
    const GIntBig expected = driver == "FlatGeobuf" ? gdal().OGR_L_GetFeatureCount(layer, FALSE) : 0;
    if (count < expected) fail(file_, "layer '{}' ends after {} of {} features", name_, count, expected);
    if (map_.points.size() == 0) fail(file_, "layer '{}' has no feature with a geometry", name_);
    map_.complete_heights(file_);
    if (without_geometry_ > 0) {
      map_.points.notes.push_back(
          fmt::format("{}: layer '{}' has {} features without a geometry", file_, name_, without_geometry_));
    }
    if (is_recoded_) {
      map_.points.notes.push_back(
          fmt::format("{}: texts are read as CP1252; a file {} can say their encoding, such as CP1250", file_,
                      path_beside(file_, ".cpg")));
    }
    return std::move(map_);
  }

 private:
  OGRLayerH choose_layer(GDALDatasetH data) {
    const std::string wanted = path_.substr(std::min(file_.size() + 1, path_.size()));
    std::vector<std::string> names;
    OGRLayerH found = nullptr;
    for (int k = 0; k < gdal().GDALDatasetGetLayerCount(data); ++k) {
      const OGRLayerH layer = gdal().GDALDatasetGetLayer(data, k);
      if (gdal().OGR_L_GetGeomType(layer) == wkbNone) continue;  // a table without places
      names.emplace_back(gdal().OGR_L_GetName(layer));
      if (wanted.empty() || wanted == names.back()) found = layer;
    }
    const bool is_clear = !wanted.empty() || names.size() == 1;
    if (found == nullptr && !names.empty())
      fail(file_, "has no layer '{}'; its layers are {}", wanted, fmt::join(names, ", "));
    if (found == nullptr) fail(file_, "has no layer with points, lines or polygons");
    if (!is_clear) {
      fail(file_, "has the layers {}: add the name of one to the path, as in {}:{}", fmt::join(names, ", "),
           file_, names.front());
    }
    name_ = gdal().OGR_L_GetName(found);
    return found;
  }

  // Finds the fields that are read.
  void read_names(OGRFeatureDefnH definition) {
    const int count = gdal().OGR_FD_GetFieldCount(definition);
    for (int k = 0; k < count; ++k) {
      const OGRFieldDefnH field = gdal().OGR_FD_GetFieldDefn(definition, k);
      fields_.emplace_back(utf8(gdal().OGR_Fld_GetNameRef(field)), gdal().OGR_Fld_GetType(field));
      map_.field_names.push_back(fields_.back().first);
    }
    for (const std::string& height : columns_.heights) {
      const int field = find_field(height);
      if (field < 0) continue;
      height_ = field;
      check_number(field);
      map_.has_height_field = true;
      break;
    }
    for (const std::string& name : columns_.fields) {
      kept_.push_back(find_field(name));
      if (kept_.back() < 0) {
        fail(file_, "layer '{}' has no field '{}'; {}", name_, name, map_.known_fields());
      }
      map_.points.fields.push_back({name, {}});
    }
  }

  int find_field(const std::string& name) const {
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      if (fields_[k].first == name) return static_cast<int>(k);
    }
    return -1;
  }
  void check_number(int field) const {
    const auto& [name, type] = fields_[static_cast<std::size_t>(field)];
    if (type != OFTInteger && type != OFTInteger64 && type != OFTReal)
      fail(file_, "layer '{}': the field '{}' is no number", name_, name);
  }

  void read_feature(OGRFeatureH feature) {
    OGRGeometryH geometry = gdal().OGR_F_GetGeometryRef(feature);
    if (geometry == nullptr || gdal().OGR_G_IsEmpty(geometry) != 0) {
      ++without_geometry_;
      return;
    }
    feature_ = gdal().OGR_F_GetFID(feature);
    const std::size_t polygons = map_.polygon_count();
    Geometry linear;
    if (gdal().OGR_G_HasCurveGeometry(geometry, FALSE) != 0) {
      linear.reset(gdal().OGR_G_GetLinearGeometry(geometry, 0, nullptr));
      geometry = linear.get();
    }
    read_geometry(geometry);
    const std::size_t n = map_.points.size();
    map_.points.heights.resize(n, height_ >= 0 ? number_of(value_of(feature, height_)) : kUnknown);
    for (std::size_t k = 0; k < kept_.size(); ++k)
      map_.points.fields[k].values.resize(n, value_of(feature, kept_[k]));
    if (map_.polygon_count() > polygons) map_.properties.resize(map_.polygon_count(), properties_of(feature));
  }

  FieldValue value_of(OGRFeatureH feature, int field) {
    if (gdal().OGR_F_IsFieldSetAndNotNull(feature, field) == 0) return {};
    const OGRFieldType type = fields_[static_cast<std::size_t>(field)].second;
    if (type == OFTInteger || type == OFTInteger64)
      return std::int64_t{gdal().OGR_F_GetFieldAsInteger64(feature, field)};
    if (type == OFTReal) return gdal().OGR_F_GetFieldAsDouble(feature, field);
    if (type == OFTDate || type == OFTTime || type == OFTDateTime) return time_of(feature, field, type);
    return utf8(gdal().OGR_F_GetFieldAsString(feature, field));
  }

  // By ISO 8601.
  static std::string time_of(OGRFeatureH feature, int field, OGRFieldType type) {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, zone = 0;
    float second = 0;
    gdal().OGR_F_GetFieldAsDateTimeEx(feature, field, &year, &month, &day, &hour, &minute, &second, &zone);
    std::string text = type == OFTTime ? "" : fmt::format("{:04}-{:02}-{:02}", year, month, day);
    if (type == OFTDate) return text;
    const bool is_whole = second == std::floor(second);
    text += fmt::format("{}{:02}:{:02}:{:0{}.{}f}", type == OFTTime ? "" : "T", hour, minute, second,
                        is_whole ? 2 : 6, is_whole ? 0 : 3);
    constexpr int kUtc = 100, kQuarter = 15;  // zones are quarters of an hour from there; 0 and 1 name none
    if (zone <= 1 || zone == kUtc) return text + (zone == kUtc ? "Z" : "");
    const int offset = kQuarter * std::abs(zone - kUtc);
    return text + fmt::format("{}{:02}:{:02}", zone < kUtc ? '-' : '+', offset / 60, offset % 60);
  }

  // Texts of a Shapefile that does not say their encoding are as they were written.
  std::string utf8(const char* text) {
    if (gdal().CPLIsUTF8(text, -1) != 0) return text;
    is_recoded_ = true;
    const std::unique_ptr<char, decltype(gdal().VSIFree)> recoded(
        gdal().CPLRecode(text, "CP1252", CPL_ENC_UTF8), gdal().VSIFree);
    return recoded.get();
  }

  // As GeoJSON has them.
  std::string properties_of(OGRFeatureH feature) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (int k = 0; k < static_cast<int>(fields_.size()); ++k) {
      auto& to = object[fields_[static_cast<std::size_t>(k)].first];
      const FieldValue found = value_of(feature, k);
      if (const auto* integer = std::get_if<std::int64_t>(&found)) to = *integer;
      if (const auto* number = std::get_if<double>(&found)) to = *number;
      if (const auto* text = std::get_if<std::string>(&found)) to = *text;
    }
    const std::string text = object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return text.substr(1, text.size() - 2);
  }

  void read_geometry(OGRGeometryH geometry) {
    const auto each_part = [&](const auto& read) {
      const int count = gdal().OGR_G_GetGeometryCount(geometry);
      for (int k = 0; k < count; ++k) read(gdal().OGR_G_GetGeometryRef(geometry, k));
    };
    switch (gdal().OGR_GT_Flatten(gdal().OGR_G_GetGeometryType(geometry))) {
      case wkbPoint:
        read_positions(geometry);
        map_.has_others = true;
        break;
      case wkbLineString:
        map_.add_line(read_positions(geometry));
        break;
      case wkbPolygon:
      case wkbTriangle:
        read_polygon(geometry);
        map_.polygon_offsets.push_back(map_.ring_offsets.size() - 1);
        break;
      case wkbMultiPolygon:
        each_part([this](OGRGeometryH part) { read_polygon(part); });
        map_.polygon_offsets.push_back(map_.ring_offsets.size() - 1);
        break;
      default:  // a collection
        each_part([this](OGRGeometryH part) { read_geometry(part); });
    }
  }

  void read_polygon(OGRGeometryH polygon) {
    const int count = gdal().OGR_G_GetGeometryCount(polygon);
    for (int k = 0; k < count; ++k) {
      const std::size_t first = read_positions(gdal().OGR_G_GetGeometryRef(polygon, k));
      if (map_.points.size() == first) continue;
      map_.add_ring(first);
      if (map_.points.size() - first < 3)
        fail(file_, "layer '{}', feature {} has a ring of fewer than 4 positions", name_, feature_);
    }
    map_.part_offsets.push_back(map_.ring_offsets.size() - 1);
  }

  // Returns the index of the first point.
  std::size_t read_positions(OGRGeometryH geometry) {
    std::vector<double>&coordinates = map_.points.coordinates, &heights = map_.points.heights;
    const std::size_t first = map_.points.size();
    const auto count = static_cast<std::size_t>(gdal().OGR_G_GetPointCount(geometry));
    if (first + count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
      fail(file_, "layer '{}' has more than {} positions", name_, std::numeric_limits<std::int32_t>::max());
    coordinates.resize(2 * (first + count));
    constexpr int kStep = 2 * sizeof(double);
    double* const at = coordinates.data() + 2 * first;
    std::vector<double> z(count);
    if (count > 0) gdal().OGR_G_GetPoints(geometry, at, kStep, at + 1, kStep, z.data(), sizeof(double));
    for (std::size_t k = 0; k < count; ++k) {
      if (std::isfinite(at[2 * k]) && std::isfinite(at[2 * k + 1])) continue;
      fail(file_, "layer '{}', feature {} has a position ({}, {}); expected finite numbers", name_, feature_,
           at[2 * k], at[2 * k + 1]);
    }
    if (height_ < 0 && gdal().OGR_G_Is3D(geometry) != 0) {
      for (double& height : z) height = std::isfinite(height) ? height : kUnknown;
      heights.resize(first, kUnknown);
      heights.insert(heights.end(), z.begin(), z.end());
    }
    return first;
  }

  Quiet quiet_;
  std::string path_, file_;
  const Columns& columns_;
  std::string name_;  // of the layer
  std::vector<std::pair<std::string, OGRFieldType>> fields_;
  int height_ = -1;        // the field that has the height
  std::vector<int> kept_;  // the fields that points keep
  GIntBig feature_ = 0;    // the one that is read, for messages
  std::size_t without_geometry_ = 0;
  bool is_recoded_ = false;  // texts that are not UTF-8
  Map map_;
};

OGRFieldType type_of(const Layer::Value& value) {
  if (std::holds_alternative<std::string>(value)) return OFTString;
  return std::holds_alternative<double>(value) ? OFTReal : OFTInteger64;
}

void set_field(OGRFeatureH feature, int field, const Layer::Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    gdal().OGR_F_SetFieldInteger64(feature, field, *integer);
  } else if (const auto* number = std::get_if<double>(&value); number != nullptr && std::isfinite(*number)) {
    gdal().OGR_F_SetFieldDouble(feature, field, *number);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    gdal().OGR_F_SetFieldString(feature, field, text->c_str());
  }
}

OGRGeometryH geometry_of(const Layer& layer, const std::vector<double>& positions) {
  constexpr int kStep = 3 * sizeof(double);
  const double* const at = positions.data();
  const OGRGeometryH line = gdal().OGR_G_CreateGeometry(layer.is_polygons ? wkbLinearRing : wkbLineString);
  gdal().OGR_G_SetPoints(line, static_cast<int>(positions.size() / 3), at, kStep, at + 1, kStep,
                         layer.has_heights ? at + 2 : nullptr, kStep);
  if (!layer.is_polygons) return line;
  const OGRGeometryH polygon = gdal().OGR_G_CreateGeometry(wkbPolygon);
  gdal().OGR_G_AddGeometryDirectly(polygon, line);
  return polygon;
}

}  // namespace

void require_gdal(const std::string& path) {
  const std::string driver = driver_of(path);
  if (driver != "GPKG") return;
  const Quiet quiet;
  const char* const drivers[] = {driver.c_str(), nullptr};
  const Dataset old(
      gdal().GDALOpenEx(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers, nullptr, nullptr));
  for (int k = 0; old && k < gdal().GDALDatasetGetLayerCount(old.get()); ++k) {
    const std::string name = gdal().OGR_L_GetName(gdal().GDALDatasetGetLayer(old.get(), k));
    if (name == "triangles" || name == "cells" || name == "contours") continue;
    fail(path, "has the layer {}, which would be lost; write another file, and add it by ogr2ogr -update",
         name);
  }
}

Map read_layer(const std::string& path, const Columns& columns) { return LayerReader(path, columns).read(); }

void write_gdal_layer(Outputs& outputs, const std::string& path, const Layer& layer) {
  const Quiet quiet;
  const auto check = [&](bool is_done) {
    if (!is_done) fail(path, "cannot be written: {}", quiet.reason());
  };
  const MemoryFile file(ending_of(path).c_str());
  Dataset data(gdal().GDALCreate(gdal_driver(driver_of(path).c_str(), path), file.path(), 0, 0, 0,
                                 GDT_Unknown, nullptr));
  check(data != nullptr);
  const System system = layer.crs.empty() ? nullptr : known_crs(layer.crs, path);
  const OGRwkbGeometryType flat = layer.is_polygons ? wkbPolygon : wkbLineString;
  const OGRwkbGeometryType spatial = layer.is_polygons ? wkbPolygon25D : wkbLineString25D;
  const bool is_shapefile = ending_of(path) == ".shp";
  // Without values, and with other names where a GeoPackage would have one twice, in any case.
  std::vector<Layer::Field> fields;
  for (const Layer::Field& field : layer.fields)
    fields.push_back(
        {ending_of(path) == ".gpkg" ? own_name(field.name, fields) : field.name, field.type, {}});
  Settings options;
  if (is_shapefile) options.set("ENCODING", "UTF-8");
  if (ending_of(path) == ".gpkg") {  // whose columns these are
    options.set("FID", own_name("fid", fields).c_str());
    options.set("GEOMETRY_NAME", own_name("geom", fields).c_str());
  }
  const OGRLayerH to = gdal().GDALDatasetCreateLayer(data.get(), layer.name.c_str(), system.get(),
                                                     layer.has_heights ? spatial : flat, options.get());
  check(to != nullptr);
  for (const Layer::Field& field : fields) {
    const OGRFieldDefnH definition = gdal().OGR_Fld_Create(field.name.c_str(), type_of(field.type));
    const bool has_field = gdal().OGR_L_CreateField(to, definition, TRUE) == OGRERR_NONE;
    gdal().OGR_Fld_Destroy(definition);
    check(has_field);
  }
  const bool has_transactions = gdal().GDALDatasetTestCapability(data.get(), ODsCTransactions) != 0;
  check(!has_transactions || gdal().GDALDatasetStartTransaction(data.get(), FALSE) == OGRERR_NONE);
  std::vector<double> positions;
  bool is_rounded = false;
  for (std::size_t k = 0; k < layer.size; ++k) {
    positions.clear();
    layer.append(k, positions);
    const Feature feature(gdal().OGR_F_Create(gdal().OGR_L_GetLayerDefn(to)));
    for (std::size_t f = 0; f < layer.fields.size(); ++f) {
      const Layer::Value value = layer.fields[f].value(k);
      set_field(feature.get(), static_cast<int>(f), value);
      const auto* integer = std::get_if<std::int64_t>(&value);
      constexpr std::int64_t kMost = 999'999'999'999'999'999, kLeast = -99'999'999'999'999'999;
      is_rounded = is_rounded || (integer != nullptr && (*integer > kMost || *integer < kLeast));
    }
    gdal().OGR_F_SetGeometryDirectly(feature.get(), geometry_of(layer, positions));
    check(gdal().OGR_L_CreateFeature(to, feature.get()) == OGRERR_NONE);
  }
  check(!has_transactions || gdal().GDALDatasetCommitTransaction(data.get()) == OGRERR_NONE);
  data.reset();
  check(!quiet.has_failed());
  for (const std::string& warning : quiet.warnings())
    outputs.notes.push_back(fmt::format("{}: {}{}", path, warning, is_shapefile ? "; .gpkg has all" : ""));
  if (is_shapefile && is_rounded) {
    outputs.notes.push_back(fmt::format(
        "{}: integers of more than 18 characters are rounded; .gpkg has all of their digits", path));
  }
  for (const std::string& each : mesh_files(path)) {
    const std::string bytes = MemoryFile(ending_of(each).c_str()).bytes();
    if (each == path || !bytes.empty()) {
      outputs.open(each).write(bytes.data(), bytes.size());
    } else if (system::status_of(each)) {
      outputs.remove(each);  // of the old file, such as its coordinate system
    }
  }
}

}  // namespace flaunay::io
