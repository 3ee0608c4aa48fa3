#pragma once

#include <filesystem>
#include <string>

#include "common/read_text.h"
#include "common/yaml.h"

namespace planbench {

/// A file that a field of another names.
struct NamedFile {
  std::filesystem::path path;
  std::string text;
};

/// `field`: its path, from `folder` unless it is absolute. Throws InputError that says where the
/// field stands if the file cannot be read.
inline NamedFile ReadNamedFile(const YamlNode& field, const std::filesystem::path& folder) {
  NamedFile file;
  file.path = folder / field.String();
  file.text = AtField(field, [&] { return ReadText(file.path); });
  return file;
}

}  // namespace planbench
