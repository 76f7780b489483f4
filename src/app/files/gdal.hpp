// GDAL's C interface, for the files that use it. The library is opened when it is first needed: it brings a
// hundred others, which take longer to load than small inputs take in all.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace flaunay::io {

#define FLAUNAY_GDAL_FUNCTIONS(X) \
  X(CPLGetErrorHandlerUserData)   \
  X(CPLIsUTF8)                    \
  X(CPLPopErrorHandler)           \
  X(CPLPrintPointer)              \
  X(CPLPushErrorHandlerEx)        \
  X(CPLRecode)                    \
  X(CSLDestroy)                   \
  X(CSLSetNameValue)              \
  X(GDALAddBand)                  \
  X(GDALAllRegister)              \
  X(GDALClose)                    \
  X(GDALCreate)                   \
  X(GDALCreateCopy)               \
  X(GDALDatasetCommitTransaction) \
  X(GDALDatasetCreateLayer)       \
  X(GDALDatasetGetLayer)          \
  X(GDALDatasetGetLayerCount)     \
  X(GDALDatasetStartTransaction)  \
  X(GDALDatasetTestCapability)    \
  X(GDALGetDriverByName)          \
  X(GDALGetRasterBand)            \
  X(GDALOpenEx)                   \
  X(GDALSetGeoTransform)          \
  X(GDALSetMetadataItem)          \
  X(GDALSetRasterNoDataValue)     \
  X(GDALSetSpatialRef)            \
  X(OGR_FD_GetFieldCount)         \
  X(OGR_FD_GetFieldDefn)          \
  X(OGR_F_Create)                 \
  X(OGR_F_Destroy)                \
  X(OGR_F_GetFID)                 \
  X(OGR_F_GetFieldAsDateTimeEx)   \
  X(OGR_F_GetFieldAsDouble)       \
  X(OGR_F_GetFieldAsInteger64)    \
  X(OGR_F_GetFieldAsString)       \
  X(OGR_F_GetGeometryRef)         \
  X(OGR_F_IsFieldSetAndNotNull)   \
  X(OGR_F_SetFieldDouble)         \
  X(OGR_F_SetFieldInteger64)      \
  X(OGR_F_SetFieldString)         \
  X(OGR_F_SetGeometryDirectly)    \
  X(OGR_Fld_Create)               \
  X(OGR_Fld_Destroy)              \
  X(OGR_Fld_GetNameRef)           \
  X(OGR_Fld_GetType)              \
  X(OGR_GT_Flatten)               \
  X(OGR_G_AddGeometryDirectly)    \
  X(OGR_G_CreateGeometry)         \
  X(OGR_G_DestroyGeometry)        \
  X(OGR_G_GetGeometryCount)       \
  X(OGR_G_GetGeometryRef)         \
  X(OGR_G_GetGeometryType)        \
  X(OGR_G_GetLinearGeometry)      \
  X(OGR_G_GetPointCount)          \
  X(OGR_G_GetPoints)              \
  X(OGR_G_HasCurveGeometry)       \
  X(OGR_G_Is3D)                   \
  X(OGR_G_IsEmpty)                \
  X(OGR_G_SetPoints)              \
  X(OGR_L_CreateFeature)          \
  X(OGR_L_CreateField)            \
  X(OGR_L_GetFeatureCount)        \
  X(OGR_L_GetGeomType)            \
  X(OGR_L_GetLayerDefn)           \
  X(OGR_L_GetName)                \
  X(OGR_L_GetNextFeature)         \
  X(OGR_L_GetSpatialRef)          \
  X(OSRDestroySpatialReference)   \
  X(OSRExportToWkt)               \
  X(OSRGetAuthorityCode)          \
  X(OSRGetAuthorityName)          \
  X(OSRGetName)                   \
  X(OSRImportFromWkt)             \
  X(OSRIsGeographic)              \
  X(OSRIsSame)                    \
  X(OSRNewSpatialReference)       \
  X(OSRSetAxisMappingStrategy)    \
  X(OSRSetFromUserInput)          \
  X(OSRStripVertical)             \
  X(VSIFree)                      \
  X(VSIGetMemFileBuffer)          \
  X(VSIUnlink)

/// Its functions, by their names.
struct Gdal {
#define MEMBER(name) decltype(&::name) name;
  FLAUNAY_GDAL_FUNCTIONS(MEMBER)
#undef MEMBER
};

/// Throws Error(usage) if the library cannot be opened.
const Gdal& gdal();

/// Keeps GDAL's messages, for errors and notes.
class Quiet {
 public:
  Quiet() { gdal().CPLPushErrorHandlerEx(keep, this); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet() { gdal().CPLPopErrorHandler(); }

  void forget() { failure_.clear(); }
  bool has_failed() const { return !failure_.empty(); }
  /// The first failure.
  std::string reason() const { return has_failed() ? failure_ : "GDAL does not say why"; }
  /// The first ones.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static void CPL_STDCALL keep(CPLErr kind, CPLErrorNum, const char* message) {
    constexpr std::size_t kMost = 10;
    auto& self = *static_cast<Quiet*>(gdal().CPLGetErrorHandlerUserData());
    if (kind == CE_Warning && self.warnings_.size() < kMost) self.warnings_.emplace_back(message);
    if (kind >= CE_Failure && self.failure_.empty()) self.failure_ = message;
  }

  std::string failure_;
  std::vector<std::string> warnings_;
};

struct Close {
  void operator()(GDALDatasetH dataset) const { gdal().GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, Close>;

struct Destroy {
  void operator()(OGRSpatialReferenceH system) const { gdal().OSRDestroySpatialReference(system); }
};
using System = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, Destroy>;

/// Of a name or WKT; null if GDAL does not know it.
System read_crs(const std::string& crs);
/// Throws Error(input) that names the path in place of null.
System known_crs(const std::string& crs, const std::string& path);
/// "EPSG:n" if it has such a number, or else WKT; empty for none.
std::string text_of(OGRSpatialReferenceH system);

/// Lists of options, as GDAL has them.
class Settings {
 public:
  Settings() = default;
  Settings(const Settings&) = delete;
  Settings& operator=(const Settings&) = delete;
  ~Settings() { gdal().CSLDestroy(list_); }
  void set(const char* name, const char* value) { list_ = gdal().CSLSetNameValue(list_, name, value); }
  char** get() { return list_; }

 private:
  char** list_ = nullptr;
};

/// Throws Error(input) with the file's name if GDAL has no such driver.
GDALDriverH gdal_driver(const char* format, const std::string& name);

/// A file of GDAL in memory.
class MemoryFile {
 public:
  explicit MemoryFile(const char* ending) : path_(std::string("/vsimem/flaunay") + ending) {}
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { gdal().VSIUnlink(path_.c_str()); }

  const char* path() const { return path_.c_str(); }
  std::string bytes() const {
    vsi_l_offset size = 0;
    const GByte* const first = gdal().VSIGetMemFileBuffer(path_.c_str(), &size, FALSE);
    return {reinterpret_cast<const char*>(first), first == nullptr ? 0 : static_cast<std::size_t>(size)};
  }

 private:
  std::string path_;
};

}  // namespace flaunay::io
