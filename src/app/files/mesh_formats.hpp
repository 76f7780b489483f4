// The formats of meshes alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/files/mesh.hpp"
#include "files/output.hpp"

namespace flaunay::io {

// Triangles, counted from 0.
std::vector<std::int32_t> read_ele(const std::string& path);
std::vector<std::int32_t> read_off(const std::string& path);
std::vector<std::int32_t> read_obj(const std::string& path);
std::vector<std::int32_t> read_ply(const std::string& path);

void write_ele(Outputs& outputs, const std::string& path, const MeshContents& contents);
void write_off(Outputs& outputs, const std::string& path, const MeshContents& contents);
void write_obj(Outputs& outputs, const std::string& path, const MeshContents& contents);
void write_ply(Outputs& outputs, const std::string& path, const MeshContents& contents);
void write_vtu(Outputs& outputs, const std::string& path, const MeshContents& contents);
/// A feature per triangle, with its corners as a ring.
void write_geojson(Outputs& outputs, const std::string& path, const MeshContents& contents);
/// A picture. Constraint edges are drawn strongly, and what is outside or a hole is in pale colours.
void write_svg(Outputs& outputs, const std::string& path, const MeshContents& contents);
void write_npy_triangles(Outputs& outputs, const std::string& path, const MeshContents& contents);

}  // namespace flaunay::io
