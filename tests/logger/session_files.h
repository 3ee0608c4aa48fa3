#pragma once

#include <filesystem>
#include <string>

namespace planbench {

/// The whole text of a file; empty if there is none.
std::string TextOf(const std::filesystem::path& file);
void WriteText(const std::filesystem::path& file, const std::string& text);

/// The contents of every table of an SQLite database as text, to be compared.
std::string DumpDatabase(const std::filesystem::path& file);

}  // namespace planbench
