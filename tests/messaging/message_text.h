#pragma once

#include <string>

#include "messaging/messages.h"

namespace planbench {

/// All fields of a message as text, doubles exactly: equal texts, equal messages. Meshes count by
/// their triangles, for resource and scale are not kept.
template <typename Message>
std::string TextOf(const Message& message);

}  // namespace planbench
