#pragma once

#include <filesystem>
#include <string>

#include "geometry/shapes.h"

namespace planbench {

/// Where the meshes of scenes lie, so that messages can name them instead of holding them:
/// $PLANBENCH_MESH_STORE, else $XDG_CACHE_HOME/planbench/meshes, else ~/.cache/planbench/meshes.
/// Throws InputError if none of these variables is set.
std::filesystem::path MeshStoreFolder();

/// Puts a mesh into the store as <MeshId>.obj, unless it is there, and returns its file:// URI. One
/// that was damaged is written anew. The file is text in the OBJ format: one `v x y z` a vertex (m,
/// shortest decimals that read back as the same doubles), one `f a b c` a triangle (vertices from
/// 1). It appears whole or not at all. Throws InputError naming the file if it cannot be written.
std::string StoreMesh(const SharedMesh& mesh);

/// Reads a file that StoreMesh wrote, or finds the mesh of that id where one is in use: what is
/// read has the id only if the file has not changed since. Unlike LoadMesh it keeps every double
/// and the order of vertices and triangles, so that MeshId stays. Throws InputError naming the file
/// (and line) if it is missing, is no such file, or has no triangles.
SharedMesh LoadStoredMesh(const std::string& uri, const std::string& mesh_id);

}  // namespace planbench
