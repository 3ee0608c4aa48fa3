#pragma once

#include <string>

namespace planbench {

/// The page that viewer serves: it listens to the events of LiveServer.
std::string LivePage();

}  // namespace planbench
