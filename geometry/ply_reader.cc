#include "geometry/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/text.h"
#include "geometry/text_words.h"

namespace planbench {
namespace {

template <typename T>
double DecodeScalar(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<double>(value);
}

struct ScalarType {
  std::string_view name;
  std::string_view other_name;
  std::size_t size;
  bool is_integer;
  double (*decode)(const char*);  // Bytes in this machine's order.
};

constexpr std::array<ScalarType, 8> kScalarTypes = {
    ScalarType{"char", "int8", 1, true, DecodeScalar<std::int8_t>},
    ScalarType{"uchar", "uint8", 1, true, DecodeScalar<std::uint8_t>},
    ScalarType{"short", "int16", 2, true, DecodeScalar<std::int16_t>},
    ScalarType{"ushort", "uint16", 2, true, DecodeScalar<std::uint16_t>},
    ScalarType{"int", "int32", 4, true, DecodeScalar<std::int32_t>},
    ScalarType{"uint", "uint32", 4, true, DecodeScalar<std::uint32_t>},
    ScalarType{"float", "float32", 4, false, DecodeScalar<float>},
    ScalarType{"double", "float64", 8, false, DecodeScalar<double>}};

struct PlyProperty {
  std::string name;
  const ScalarType* type = nullptr;
  const ScalarType* count_type = nullptr;  // Of a list alone.
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

class PlyReader {
 public:
  PlyReader(std::string_view data, const std::string& file) : rest_(data), file_(file) {
    const std::size_t end = rest_.find_first_of("\r\n");
    if (end != std::string_view::npos && !rest_.substr(end).starts_with("\r\n")) {
      line_end_ = rest_[end];
    }
    ReadHeader();
    for (const PlyElement& element : elements_) ReadElement(element);
    RefuseRest();
  }

  Polygons Take() { return std::move(polygons_); }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    if (is_text_) {
      throw InputError(fmt::format("{}:{}: {}{}", file_, line_number_, place_, what));
    }
    throw InputError(fmt::format("{}: {}{}", file_, place_, what));
  }

  // By one kind of line end alone: the first byte of binary data may look like another.
  std::optional<std::string_view> NextLine() {
    if (rest_.empty()) return std::nullopt;
    ++line_number_;
    const std::size_t end = rest_.find(line_end_);
    line_has_end_ = end != std::string_view::npos;
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(line_has_end_ ? end + 1 : rest_.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void ReadHeader() {
    const auto first = NextLine();
    std::string_view magic = first.value_or("");
    if (TakeWord(&magic) != "ply") Fail("is no PLY file: it does not begin with \"ply\"");
    std::string format;
    while (true) {
      const auto line = NextLine();
      if (!line) Fail("the file ends before end_header; it is cut off");
      std::string_view words = *line;
      const std::string_view keyword = TakeWord(&words);
      if (keyword == "end_header") break;
      if (keyword == "format") {
        format = TakeWord(&words);
      } else if (keyword == "element") {
        AddElement(words);
      } else if (keyword == "property") {
        AddProperty(words);
      } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
        Fail(fmt::format("'{}': unknown in a header", Printable(keyword)));
      }
    }
    const bool is_big = format == "binary_big_endian";
    is_reversed_ = is_big != (std::endian::native == std::endian::big);
    if (format != "ascii" && format != "binary_little_endian" && !is_big) {
      Fail(fmt::format("format '{}': must be ascii, binary_little_endian or binary_big_endian",
                       Printable(format)));
    }
    for (const PlyElement& element : elements_) CheckElement(element);
    is_text_ = format == "ascii";
  }

  void AddElement(std::string_view words) {
    PlyElement element;
    element.name = TakeWord(&words);
    const std::string_view count = TakeWord(&words);
    const char* const last = count.data() + count.size();
    const auto [end, error] = std::from_chars(count.data(), last, element.count);
    if (error != std::errc() || end != last) Fail("element: expected a name and a number");
    if (std::ranges::count(elements_, element.name, &PlyElement::name) != 0) {
      Fail(fmt::format("element {}: there is one before", element.name));
    }
    if (element.name == "vertex") num_vertices_ = element.count;
    elements_.push_back(element);
  }

  const ScalarType* FindType(std::string_view name) const {
    const auto type = std::ranges::find_if(kScalarTypes, [&](const ScalarType& known) {
      return name == known.name || name == known.other_name;
    });
    if (type == kScalarTypes.end()) {
      Fail(fmt::format("property: unknown type '{}'", Printable(name)));
    }
    return &*type;
  }

  void AddProperty(std::string_view words) {
    if (elements_.empty()) Fail("property: there is no element before");
    PlyProperty property;
    std::string_view type = TakeWord(&words);
    if (type == "list") {
      property.count_type = FindType(TakeWord(&words));
      if (!property.count_type->is_integer) Fail("property list: its count must be an integer");
      type = TakeWord(&words);
    }
    property.type = FindType(type);
    property.name = TakeWord(&words);
    elements_.back().properties.push_back(property);
  }

  static bool IsStrips(const PlyElement& element) { return element.name == "tristrips"; }

  static bool IsCorners(const PlyElement& element, const PlyProperty& property) {
    return (element.name == "face" || IsStrips(element)) && property.count_type != nullptr &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  // 0 to 2 for x, y and z of a vertex.
  static std::optional<Eigen::Index> Axis(const PlyElement& element, const PlyProperty& property) {
    const std::size_t axis = std::string_view("xyz").find(property.name);
    const bool is_one = element.name == "vertex" && property.count_type == nullptr &&
                        property.name.size() == 1 && axis != std::string_view::npos;
    if (!is_one) return std::nullopt;
    return static_cast<Eigen::Index>(axis);
  }

  void CheckElement(const PlyElement& element) const {
    const auto num_axes = std::ranges::count_if(element.properties, [&](const PlyProperty& each) {
      return Axis(element, each).has_value();
    });
    if (element.name == "vertex" && num_axes != 3) Fail("element vertex: has no x, y and z");
    const auto num_lists = std::ranges::count_if(
        element.properties, [&](const PlyProperty& each) { return IsCorners(element, each); });
    if ((element.name == "face" || IsStrips(element)) && num_lists != 1) {
      Fail(fmt::format("element {}: needs one list of vertex_indices", element.name));
    }
  }

  void ReadElement(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t i = 1; i <= element.count; ++i) {
      place_ = fmt::format("{} {} of {}: ", element.name, i, element.count);
      if (is_text_) TakeElementLine();
      Eigen::Vector3d position = Eigen::Vector3d::Zero();
      for (const PlyProperty& property : element.properties) {
        digits_may_follow_ = false;
        if (property.count_type != nullptr) {
          ReadList(property);
          if (IsCorners(element, property)) AddCorners(IsStrips(element));
        } else {
          const double value = TakeValue(*property.type);
          if (const auto axis = Axis(element, property)) {
            position(*axis) = value;
            digits_may_follow_ = true;
          }
        }
      }
      if (element.name == "vertex") AddVertex(position);
    }
    place_.clear();
  }

  void TakeElementLine() {
    while (true) {
      const auto line = NextLine();
      if (!line) Fail("is missing; the file is cut off");
      words_ = *line;
      if (line->find_first_not_of(" \t") != std::string_view::npos) return;
    }
  }

  double TakeValue(const ScalarType& type) {
    if (is_text_) {
      const std::string_view word = TakeWord(&words_);
      if (word.empty()) Fail("the line has too few numbers; is the file cut off?");
      const auto number = ParseNumber(word);
      if (!number) Fail(fmt::format("'{}' is no number", Printable(word)));
      return *number;
    }
    if (rest_.size() < type.size) Fail("the file ends here; it is cut off");
    std::array<char, sizeof(double)> bytes{};
    std::copy_n(rest_.begin(), type.size, bytes.begin());
    if (is_reversed_) std::reverse(bytes.begin(), bytes.begin() + type.size);
    rest_.remove_prefix(type.size);
    return type.decode(bytes.data());
  }

  void ReadList(const PlyProperty& property) {
    const double count = TakeValue(*property.count_type);
    if (!(count >= 0) || count != std::floor(count)) {
      Fail(fmt::format("{}: {} is no length of a list", property.name, count));
    }
    list_.clear();
    while (static_cast<double>(list_.size()) < count) list_.push_back(TakeValue(*property.type));
  }

  void AddVertex(const Eigen::Vector3d& position) {
    if (!position.allFinite()) Fail("is not finite");
    polygons_.AddVertex(position);
  }

  void AddCorners(bool is_strips) {
    std::vector<std::uint32_t> corners;
    for (const double index : list_) {
      digits_may_follow_ = index > 0 && 10 * index < static_cast<double>(num_vertices_);
      if (is_strips && index == -1) {
        AddStrip(corners);
        corners.clear();
        continue;
      }
      if (!(index >= 0 && index < static_cast<double>(num_vertices_)) ||
          index != std::floor(index)) {
        Fail(fmt::format("there is no vertex {}; the file has {}, counted from 0", index,
                         num_vertices_));
      }
      corners.push_back(static_cast<std::uint32_t>(index));
    }
    if (is_strips) {
      AddStrip(corners);
    } else {
      AddFace(corners);
    }
  }

  // Every second triangle of a strip turns the other way.
  void AddStrip(const std::vector<std::uint32_t>& strip) {
    for (std::size_t i = 2; i < strip.size(); ++i) {
      const bool is_odd = i % 2 != 0;
      AddFace({strip[i - (is_odd ? 1 : 2)], strip[i - (is_odd ? 2 : 1)], strip[i]});
    }
  }

  void AddFace(const std::vector<std::uint32_t>& corners) {
    if (corners.size() < 3) Fail("has fewer than three corners");
    polygons_.AddPolygon(corners);
  }

  void RefuseRest() const {
    // A number that is cut off is a number.
    if (is_text_ && !line_has_end_ && words_.empty() && digits_may_follow_) {
      Fail(
          "the last line has no end, so that its last number may be cut off; if it is whole, end "
          "the line (echo >> FILE)");
    }
    constexpr std::string_view kFilling(" \t\r\n\0", 5);
    if (rest_.find_first_not_of(kFilling) == std::string_view::npos) return;
    throw InputError(
        fmt::format("{}: {} bytes follow what its header tells of; its counts are wrong, or it is "
                    "damaged",
                    file_, rest_.size()));
  }

  std::string_view rest_;
  const std::string& file_;
  char line_end_ = '\n';
  int line_number_ = 0;
  bool line_has_end_ = true;
  bool is_text_ = true;  // What is being read: the header, or a body that is.
  bool is_reversed_ = false;
  std::vector<PlyElement> elements_;
  std::uint64_t num_vertices_ = 0;
  std::string place_;       // Element being read, for messages.
  std::string_view words_;  // Left of its line.
  // The number that came last is used, and would be another, as good, with more digits.
  bool digits_may_follow_ = false;
  std::vector<double> list_;
  Polygons polygons_;
};

}  // namespace

Polygons ReadPly(std::string_view data, const std::string& file) {
  return PlyReader(data, file).Take();
}

}  // namespace planbench
