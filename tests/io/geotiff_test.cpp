// GeoTIFF files, read back by GDAL.
#include "app/files/geotiff.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <string>
#include <vector>

#include "tests/io/folder.hpp"

namespace flaunay::io {
namespace {

class GeoTiffTest : public FolderTest {};

TEST_F(GeoTiffTest, HasPixelsPlaceAndSystem) {
  constexpr int kRows = 600, kColumns = 700;  // more than a tile
  std::vector<float> pixels(kRows * kColumns);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = i % 7 == 0 ? -9999.0F : 0.25F * static_cast<float>(i % 999);
  const std::string file = path("dem.tif");
  for (const bool is_point : {false, true}) {
    write_geotiff(file, "dem.tif",
                  {pixels.data(), kRows, kColumns, 500000.5, 6000000, 0.5, is_point, -9999, "EPSG:25832"});
    auto* const written = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_ReadOnly));
    ASSERT_NE(written, nullptr);
    ASSERT_EQ(written->GetRasterXSize(), kColumns);
    ASSERT_EQ(written->GetRasterYSize(), kRows);
    std::vector<float> read(pixels.size());
    GDALRasterBand* const band = written->GetRasterBand(1);
    ASSERT_EQ(band->RasterIO(GF_Read, 0, 0, kColumns, kRows, read.data(), kColumns, kRows, GDT_Float32, 0, 0),
              CE_None);
    EXPECT_EQ(read, pixels);
    EXPECT_EQ(band->GetNoDataValue(), -9999);
    EXPECT_EQ(band->GetOverviewCount(), 1);
    std::array<double, 6> transform{};
    written->GetGeoTransform(transform.data());
    EXPECT_EQ(transform, (std::array<double, 6>{500000.5, 0.5, 0, 6000000, 0, -0.5}));
    EXPECT_EQ(std::string(written->GetMetadataItem("AREA_OR_POINT")), is_point ? "Point" : "Area");
    EXPECT_EQ(std::string(written->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE")), "COG");
    EXPECT_EQ(std::string(written->GetSpatialRef()->GetAuthorityCode(nullptr)), "25832");
    GDALClose(written);
  }
}

TEST_F(GeoTiffTest, SystemsAreCompared) {
  EXPECT_TRUE(is_same_crs("EPSG:25832", crs_text("EPSG:25832")));
  EXPECT_FALSE(is_same_crs("EPSG:25832", "EPSG:25833"));
  EXPECT_EQ(epsg_code(crs_text("EPSG:25832")), 25832);
  EXPECT_THROW(crs_text("nonsense"), Error);
  EXPECT_NO_THROW(check_crs(crs_text("+proj=utm +zone=32"), "a"));
  EXPECT_THROW(check_crs("+proj=utm +zone=32", "a"), Error);
}

TEST_F(GeoTiffTest, WhatCannotBeWrittenIsAnError) {
  float pixel = 0;
  EXPECT_THROW(write_geotiff(path("none/dem.tif"), "dem.tif", {&pixel, 1, 1, 0, 1, 1, false, -1, ""}), Error);
}

}  // namespace
}  // namespace flaunay::io
