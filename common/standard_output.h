#pragma once

#include <string>
#include <string_view>

namespace planbench {

/// Writes to standard output. What cannot be written ends nothing: it is a fault at the end.
void WriteOut(std::string_view text);

/// Flushes standard output and says what is wrong if not all that was written there, in whatever
/// way, has arrived. Empty if it has, or if its reader has gone, as `head` does when it has enough.
std::string StandardOutputFault();

}  // namespace planbench
