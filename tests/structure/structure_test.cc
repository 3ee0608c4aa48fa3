#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

// The rules that keep the rooms apart. They are those of the table of rooms in
// docs/architecture.md, checked on what the sources include.
namespace planbench {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// Libraries that stay in the rooms whose row names them, and how their headers begin.
const std::map<std::string, std::vector<std::string>> kConfinedLibraries = {
    {"LCM", {"lcm/", "planbench/lcmt_"}},
    {"OMPL", {"ompl/"}},
    {"FCL", {"fcl/"}},
    {"Highway", {"hwy/"}},
    {"SQLite", {"sqlite3.h"}},
    {"cpp-httplib", {"httplib.h"}},
    {"assimp", {"assimp/"}},
    {"urdfdom", {"urdf_parser/", "urdf_model/", "urdf_world/"}},
    {"tinyxml2", {"tinyxml2.h"}},
    {"yaml-cpp", {"yaml-cpp/"}},
    {"xxHash", {"xxhash.h"}},
    {"zlib", {"zlib.h"}},
};

std::string Read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Every folder that CMake takes in as a room, but for tests and benchmarks, which may use all.
Names RoomsOfTheTree() {
  Names rooms;
  for (const auto& entry : fs::directory_iterator(PLANBENCH_SOURCE_DIR)) {
    if (fs::exists(entry.path() / "CMakeLists.txt")) rooms.insert(entry.path().filename());
  }
  rooms.erase("tests");
  rooms.erase("benchmarks");
  return rooms;
}

/// Last column of a room's row: rooms and libraries.
std::map<std::string, Names> ReadTable() {
  static const std::regex row(R"(\| `(\w+)/` \|.*\| ([^|]*) \|)");
  const std::string text = Read(fs::path(PLANBENCH_SOURCE_DIR) / "docs" / "architecture.md");
  std::map<std::string, Names> table;
  for (std::sregex_iterator it(text.begin(), text.end(), row), end; it != end; ++it) {
    const std::string list = (*it)[2];
    static const std::regex comma(", ");
    const std::sregex_token_iterator first(list.begin(), list.end(), comma, -1);
    Names names(first, std::sregex_token_iterator());
    names.erase("nothing");
    table[(*it)[1]] = std::move(names);
  }
  return table;
}

const std::map<std::string, Names>& Table() {
  static const std::map<std::string, Names> table = ReadTable();
  return table;
}

/// The rooms that `room` stands on, itself included, and what they stand on.
Names RoomsBelow(const std::string& room) {
  Names below;
  std::vector<std::string> open = {room};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    if (!Table().contains(next) || !below.insert(next).second) continue;
    open.insert(open.end(), Table().at(next).begin(), Table().at(next).end());
  }
  return below;
}

struct Source {
  fs::path path;  // below the checkout
  std::string room;
  std::string text;
  std::vector<std::string> includes;
};

std::vector<Source> ReadSources() {
  static const std::regex include(R"(#include\s*[<"]([^>"]+)[>"])");
  std::vector<Source> sources;
  for (const std::string& room : RoomsOfTheTree()) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(PLANBENCH_SOURCE_DIR) / room)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cc") continue;
      Source source{fs::relative(entry.path(), PLANBENCH_SOURCE_DIR), room, Read(entry.path()), {}};
      for (std::sregex_iterator it(source.text.begin(), source.text.end(), include), end; it != end;
           ++it) {
        source.includes.push_back((*it)[1]);
      }
      sources.push_back(std::move(source));
    }
  }
  return sources;
}

const std::vector<Source>& Sources() {
  static const std::vector<Source> sources = ReadSources();
  return sources;
}

TEST(Structure, TheTableNamesEveryRoom) {
  for (const std::string& room : RoomsOfTheTree()) {
    EXPECT_TRUE(Table().contains(room)) << room << "/ has no row in docs/architecture.md";
  }
  for (const auto& [room, names] : Table()) {
    EXPECT_TRUE(fs::is_directory(fs::path(PLANBENCH_SOURCE_DIR) / room)) << "no folder " << room;
  }
}

TEST(Structure, DependenciesPointOneWay) {
  for (const auto& [room, names] : Table()) {
    for (const std::string& name : names) {
      EXPECT_FALSE(RoomsBelow(name).contains(room)) << room << " and " << name;
      EXPECT_FALSE(fs::exists(fs::path(PLANBENCH_SOURCE_DIR) / name / "main.cc"))
          << room << " includes headers of the process " << name;
    }
  }
}

TEST(Structure, RoomsIncludeOnlyWhatIsBelowThem) {
  int checked = 0;
  for (const Source& source : Sources()) {
    const Names below = RoomsBelow(source.room);
    for (const std::string& include : source.includes) {
      const std::string room = include.substr(0, include.find('/'));
      if (!Table().contains(room)) continue;
      ++checked;
      EXPECT_TRUE(below.contains(room)) << source.path << " includes " << include;
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(Structure, LibrariesStayInTheRoomsThatNameThem) {
  Names used;
  for (const Source& source : Sources()) {
    for (const std::string& include : source.includes) {
      for (const auto& [library, beginnings] : kConfinedLibraries) {
        if (std::none_of(beginnings.begin(), beginnings.end(), [&](const std::string& beginning) {
              return include.starts_with(beginning);
            })) {
          continue;
        }
        used.insert(library);
        EXPECT_TRUE(Table().at(source.room).contains(library))
            << source.path << " includes " << include;
      }
    }
  }
  EXPECT_EQ(used.size(), kConfinedLibraries.size()) << "a library's headers begin otherwise";
}

TEST(Structure, WireTypesStayWhereLcmIs) {
  static const std::regex wire_type(R"(\blcmt_\w+\s+\w+[;({])");
  for (const Source& source : Sources()) {
    if (Table().at(source.room).contains("LCM")) continue;
    EXPECT_FALSE(std::regex_search(source.text, wire_type)) << source.path << " uses a wire type";
  }
}

TEST(Structure, ARoomsFilesNameDifferentThingsDifferently) {
  // So that a room can be compiled as one file; of several programs only the mains are apart.
  static const std::regex type_or_constant(
      R"(^(?:(?:class|struct|enum class) (\w+)\b[^;(]*\{|(?:inline |static )*const(?:expr)?\b[^=;(]*?\b(k[A-Z]\w*)(?:\[[^\]]*\])* ?[={]).*)");
  const fs::path root = PLANBENCH_SOURCE_DIR;
  std::vector<fs::path> rooms;
  for (const std::string& room : RoomsOfTheTree()) rooms.push_back(root / room);
  for (const auto& entry : fs::directory_iterator(root / "tests")) {
    if (entry.is_directory()) rooms.push_back(entry.path());
  }
  int num_names = 0;
  for (const fs::path& room : rooms) {
    std::map<std::string, fs::path> definitions;
    for (const auto& entry : fs::recursive_directory_iterator(room)) {
      if (entry.path().extension() != ".cc" || entry.path().stem().string().ends_with("main")) {
        continue;
      }
      std::ifstream file(entry.path());
      std::smatch match;
      for (std::string line; std::getline(file, line);) {
        if (!std::regex_match(line, match, type_or_constant)) continue;
        const auto [first, is_new] =
            definitions.emplace(match[1].str() + match[2].str(), entry.path());
        num_names += is_new ? 1 : 0;
        EXPECT_EQ(first->second, entry.path()) << first->first;
      }
    }
  }
  EXPECT_GT(num_names, 500);
}

TEST(Structure, AStatementDrawsOneRandomNumber) {
  // Of several, compilers choose the order: GCC begins at the end on x86-64, at the front on ARM.
  static const std::regex two_draws(
      R"((?:UniformFraction|->Draw)\([^;{}]*(?:UniformFraction|->Draw)\()");
  for (const Source& source : Sources()) {
    EXPECT_FALSE(std::regex_search(source.text, two_draws)) << source.path;
  }
}

TEST(Structure, FclStaysOutOfHeaders) {
  for (const Source& source : Sources()) {
    if (source.path.extension() != ".h") continue;
    for (const std::string& include : source.includes) {
      EXPECT_FALSE(include.starts_with("fcl/")) << source.path << " includes " << include;
    }
  }
}

}  // namespace
}  // namespace planbench
