#pragma once

#include <linux/filter.h>

#include <set>
#include <string>
#include <vector>

namespace planbench {

/// A program for a UDP socket (SO_ATTACH_FILTER, socket(7)) with which the kernel drops what LCM
/// sends in one packet on a channel that is none of these. All other packets pass: fragments of
/// larger messages, of which only the first says its channel, and what breaks the protocol. A
/// packet shorter than what the program looks at is dropped.
std::vector<sock_filter> ChannelFilter(const std::set<std::string>& channels);

}  // namespace planbench
