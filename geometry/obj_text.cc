#include "geometry/obj_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/text.h"
#include "geometry/text_words.h"

namespace planbench {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& file) : lines_(text), file_(file) {
    while (const auto line = NextStatement()) Read(*line);
    if (highest_index_ > num_vertices_) {
      Fail(line_of_highest_,
           fmt::format("f: there is no vertex {}; the file has {}", highest_index_, num_vertices_));
    }
  }

  Polygons Take() { return std::move(polygons_); }

 private:
  [[noreturn]] void Fail(int line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line, what));
  }

  static bool IsVertex(std::string_view keyword) { return keyword == "v"; }
  // The second is what it was called once.
  static bool IsFace(std::string_view keyword) { return keyword == "f" || keyword == "fo"; }

  // The next line without its comment.
  std::optional<std::string> NextLine() {
    const auto line = lines_.Next();
    if (!line) return std::nullopt;
    return std::string(line->substr(0, line->find('#')));
  }

  // A line, and, of a vertex or a face, those that a backslash at its end continues it by. What
  // continues other statements is none that is read, but a backslash may also end the name of a
  // folder there, and what follows is a statement of its own.
  std::optional<std::string> NextStatement() {
    std::optional<std::string> statement = NextLine();
    if (!statement) return std::nullopt;
    std::string_view words = *statement;
    std::string_view keyword = TakeWord(&words);
    if (keyword.ends_with('\\')) keyword.remove_suffix(1);
    if (!IsVertex(keyword) && !IsFace(keyword)) return statement;
    while (statement->ends_with('\\')) {
      statement->back() = ' ';
      *statement += NextLine().value_or("");
    }
    return statement;
  }

  void Read(std::string_view statement) {
    const std::string_view keyword = TakeWord(&statement);
    if (IsVertex(keyword)) {
      ReadVertex(statement);
    } else if (IsFace(keyword)) {
      ReadFace(statement);
    }
  }

  void ReadVertex(std::string_view words) {
    Eigen::Vector3d vertex;
    for (double& value : vertex) {  // A weight or a colour may follow.
      const auto number = ParseNumber(TakeWord(&words));
      if (!number || !std::isfinite(*number)) {
        Fail(lines_.number(), "v: expected three finite numbers");
      }
      value = *number;
    }
    polygons_.AddVertex(vertex);
    ++num_vertices_;
  }

  void ReadFace(std::string_view words) {
    std::vector<std::uint32_t> corners;
    for (std::string_view word = TakeWord(&words); !word.empty(); word = TakeWord(&words)) {
      corners.push_back(static_cast<std::uint32_t>(ReadIndex(word) - 1));
    }
    // Lines and points have elements of their own: this one lost its corners.
    if (corners.size() < 3) {
      Fail(lines_.number(), "f: a face has three corners at least; is the file cut off?");
    }
    polygons_.AddPolygon(corners);
  }

  // The vertex, counted from 1, of "7", "7/1", "7//3" or "7/1/3"; -1 is the last one so far.
  int ReadIndex(std::string_view word) {
    const std::string_view digits = word.substr(0, word.find('/'));
    int index = 0;
    const char* const last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, index);
    const bool is_relative = index < 0;
    if (is_relative) index += num_vertices_ + 1;
    if (error != std::errc() || end != last || index < 1) {
      Fail(lines_.number(), fmt::format("f: '{}' names no vertex", word));
    }
    if (index > highest_index_) {
      highest_index_ = index;
      line_of_highest_ = lines_.number();
    }
    return index;
  }

  TextLines lines_;
  const std::string& file_;
  Polygons polygons_;
  int num_vertices_ = 0;
  int highest_index_ = 0;  // That a face names: vertices may follow later.
  int line_of_highest_ = 0;
};

}  // namespace

Polygons ReadObj(std::string_view text, const std::string& file) {
  RefuseUtf16(text, file);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // The mark of UTF-8.
  return ObjReader(text, file).Take();
}

}  // namespace planbench
