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

namespace flaunay::io {

#define FLAUNAY_GDAL_FUNCTIONS(X) \
  X(CPLErrorReset)                \
  X(CPLGetLastErrorMsg)           \
  X(CPLGetLastErrorType)          \
  X(CPLPopErrorHandler)           \
  X(CPLPrintPointer)              \
  X(CPLPushErrorHandler)          \
  X(CPLQuietErrorHandler)         \
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
  X(OGR_L_GetGeomType)            \
  X(OGR_L_GetLayerDefn)           \
  X(OGR_L_GetName)                \
  X(OGR_L_GetNextFeature)         \
  X(OGR_L_GetSpatialRef)          \
  X(OSRDestroySpatialReference)   \
  X(OSRExportToWkt)               \
  X(OSRGetAuthorityCode)          \
  X(OSRGetAuthorityName)          \
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

/// Turns GDAL's messages into messages of errors.
class Quiet {
 public:
  Quiet() {
    gdal().CPLPushErrorHandler(gdal().CPLQuietErrorHandler);
    gdal().CPLErrorReset();
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet() { gdal().CPLPopErrorHandler(); }

  std::string reason() const {
    const std::string message = gdal().CPLGetLastErrorMsg();
    return message.empty() ? "GDAL does not say why" : message;
  }
};

struct Close {
  void operator()(GDALDatasetH dataset) const { gdal().GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, Close>;

struct Destroy {
  void operator()(OGRSpatialReferenceH system) const { gdal().OSRDestroySpatialReference(system); }
};
using System = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, Destroy>;

/// Null if GDAL does not know it.
System read_crs(const std::string& crs);
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
