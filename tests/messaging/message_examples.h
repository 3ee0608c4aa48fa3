#pragma once

#include "scene/scene.h"
#include "tests/messaging/field_archives.h"

namespace planbench {

/// Primitives of every kind, a mesh, an attached object, allowed collisions, a further frame.
Scene ExampleScene();
/// A tetrahedron whose coordinates have no short decimal form.
TriangleMesh ExampleMesh();

/// A message with every field set to something other than its default.
template <typename Message>
Message Example() {
  Message message;
  if constexpr (std::is_same_v<Message, SceneMessage>) {
    const Scene scene = ExampleScene();
    message = {"r", SceneId(scene), true, "note", scene};
  } else {
    typename Fields<Message>::Wire unused{};
    Filler filler;
    Fields<Message>::List(filler, message, unused);
  }
  return message;
}

}  // namespace planbench
