#pragma once

#include <filesystem>

#include "report/table.h"

namespace planbench {

/// Writes the figures of every set (FigureData) into a folder as SVG, by node and Vega, and, where
/// rsvg-convert is installed, as PDF, in the place of those of an earlier report, whatever its sets
/// (ReplaceFiles). Says on stderr what it has to leave out. Throws InputError if node is missing,
/// std::runtime_error if it fails.
void PrintFigures(const Json& data, const std::filesystem::path& folder);

}  // namespace planbench
