#pragma once

#include "messaging/messages.h"

namespace planbench {

/// A message of each type with every field set to something other than its default.
template <typename Message>
Message Example();

/// Primitives of every kind, a mesh, an attached object, allowed collisions, a further frame.
Scene ExampleScene();
/// A tetrahedron whose coordinates have no short decimal form.
TriangleMesh ExampleMesh();

}  // namespace planbench
