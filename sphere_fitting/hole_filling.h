#pragma once

#include "geometry/shapes.h"

namespace planbench {

/// Fills small holes of parts of a mesh that are not closed: edges of an odd number of triangles
/// form loops, and each is spanned by a fan of triangles, if all loops of the part together come to
/// no more than a fiftieth of its area. Such holes are flaws of an export. Vertices must be joined
/// (LoadMesh). Returns how many holes were filled.
int FillSmallHoles(TriangleMesh* mesh);

}  // namespace planbench
