#pragma once

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/numbers.h"
#include "messaging/message_fields.h"

/// Archives (messaging/fields.h) that test all messages by the one list of their fields.
namespace planbench {

/// Fills a value with what is not its default and differs from field to field; lists get two
/// elements.
class Filler {
 public:
  static constexpr bool kReads = true;

  void Utime(std::int64_t&) {}

  template <typename Value, typename Wire, typename Rule = rules::Anything>
  void Field(const char* /*name*/, Value& value, Wire& wire, Rule = {}) {
    if constexpr (HasFields<Value>) {
      Fields<Value>::List(*this, value, wire);
    } else if constexpr (std::is_array_v<Wire>) {
      for (auto& number : value) Fill(number);
    } else {
      Fill<Rule>(value);
    }
  }
  template <typename Value, typename Wire, typename Rule = rules::Anything>
  void List(const char* /*name*/, std::vector<Value>& values, std::vector<Wire>&, std::int32_t&,
            Rule = {}) {
    for (int i = 0; i < 2; ++i) {
      Wire unused{};
      Field("", values.emplace_back(), unused);
    }
  }
  template <typename Value, typename Wire, typename Rule = rules::Anything>
  void List(const char* /*name*/, std::map<std::string, Value>& values, std::vector<Wire>&,
            std::int32_t&, Rule = {}) {
    for (int i = 0; i < 2; ++i) {
      std::pair<std::string, Value> entry;
      Wire unused{};
      Field("", entry, unused);
      values.insert(entry);
    }
  }
  template <typename Values, typename Wires, typename Rule = rules::Anything>
  void Beside(const char* name, Values& values, Wires& wires, std::int32_t& count, Rule = {}) {
    List(name, values, wires, count);
  }
  template <typename Row>
  void Rows(const char* /*name*/, std::vector<Row>& rows, std::vector<Row>&, std::int32_t&,
            std::int32_t&) {
    rows.assign(2, Row(2));
    for (Row& row : rows) {
      for (auto& number : row) Fill(number);
    }
  }
  template <typename Value, typename Wire>
  void Optional(const char* name, std::optional<Value>& value, Wire& wire, const char*,
                std::int8_t&) {
    Field(name, value.emplace(), wire);
  }
  template <typename... Args>
  void Require(bool, const char*, const char*, const Args&...) {}

 private:
  template <typename Rule = rules::Anything, typename Value>
  void Fill(Value& value) {
    ++count_;
    if constexpr (std::is_same_v<Value, bool>) {
      value = !value;
    } else if constexpr (std::is_enum_v<Value>) {
      value = EnumValues<Value>().back();
    } else if constexpr (std::is_integral_v<Value>) {
      value = static_cast<Value>(count_);
    } else if constexpr (std::is_same_v<Rule, rules::Seconds>) {
      value = count_ / 64.0;  // Improvements are told in order,
    } else if constexpr (std::is_same_v<Rule, rules::Bound>) {
      value = 1 + 1.0 / count_;
    } else if constexpr (std::is_floating_point_v<Value>) {
      value = 1.0 / (count_ + 1);  // and cost less and less. A fraction, too.
    } else if constexpr (std::is_same_v<Value, std::string>) {
      value = fmt::format("text-{}", count_);  // A node's name, too.
    } else {
      Fill(value.emplace());
    }
  }

  int count_ = 0;
};

/// Spoils one thing after the other of an lcmt_ struct that was good: a number that is not finite
/// or out of range, an empty or repeated name, an enum's value that there is not.
class Spoiler {
 public:
  static constexpr bool kReads = false;

  /// Spoils the `which`-th thing, from 0.
  explicit Spoiler(int which) : which_(which) {}
  /// Place of what was spoilt, "path.to.field[3]"; empty if there is no such thing any more.
  const std::string& place() const { return place_; }

  void Utime(std::int64_t&) {}

  template <typename Value, typename Wire, typename Rule = rules::Default<Value>>
  void Field(const std::string& name, Value& value, Wire& wire, Rule = {}) {
    if (name == "num_joints") return;  // The width of rows: no encoder could do with a wrong one.
    if constexpr (HasFields<Value>) {
      Struct(name, value, wire);
    } else if constexpr (std::is_array_v<Wire>) {
      using Each = std::conditional_t<rules::OfList<Rule, Wire>, rules::Finite, Rule>;
      for (std::size_t i = 0; i < std::size(wire); ++i) {
        SpoilValue<double, Each>(fmt::format("{}[{}]", name, i), wire[i]);
      }
      if (rules::OfList<Rule, Wire> && Chosen(name)) wire[0] += 1;
    } else {
      SpoilValue<Value, Rule>(name, wire);
    }
  }
  template <typename Values, typename Wire, typename Rule = rules::Default<Wire>>
  void List(const char* name, Values&, std::vector<Wire>& wires, std::int32_t&, Rule = {}) {
    using Element = ElementOf<Values>;
    for (std::size_t i = 0; i < wires.size(); ++i) {
      const std::string place = fmt::format("{}[{}]", name, i);
      if constexpr (HasFields<Element>) {
        Element unused;
        Struct(place, unused, wires[i]);
        if constexpr (HasKey<Element>) {
          if (i > 0 && Chosen(place + "." + Fields<Element>::kKey)) wires[i] = wires[0];
        }
      } else if constexpr (rules::OfList<Rule, std::vector<Wire>>) {
        if (i > 0 && Chosen(place)) wires[i] = wires[0];  // Of names and of ascending numbers.
      } else {
        SpoilValue<Element, Rule>(place, wires[i]);
      }
    }
  }
  template <typename Values, typename Wires, typename Rule = rules::Anything>
  void Beside(const char* name, Values& values, Wires& wires, std::int32_t& count, Rule rule = {}) {
    List(name, values, wires, count, rule);
  }
  template <typename Values, typename Row>
  void Rows(const char* name, Values&, std::vector<Row>& rows, std::int32_t&, std::int32_t&) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows[i].size(); ++j) {
        SpoilValue<double, rules::Finite>(fmt::format("{}[{}][{}]", name, i, j), rows[i][j]);
      }
    }
  }
  template <typename Value, typename Wire>
  void Optional(const char* name, Value&, Wire& wire, const char* flag_name, std::int8_t& flag) {
    SpoilValue<bool, rules::Anything>(fmt::format("{}.{}", name, flag_name), flag);
    typename Value::value_type unused;
    Struct(name, unused, wire);
  }
  template <typename... Args>
  void Require(bool, const char*, const char*, const Args&...) {}

 private:
  template <typename Value, typename Wire>
  void Struct(const std::string& name, Value& value, Wire& wire) {
    const std::string before = std::exchange(path_, path_ + name + ".");
    Fields<Value>::List(*this, value, wire);
    path_ = before;
  }

  bool Chosen(const std::string& name) {
    if (count_++ != which_) return false;
    place_ = path_ + name;
    return true;
  }

  /// Whatever of these the rule or the type forbids.
  template <typename Value, typename Rule, typename Wire>
  void SpoilValue(const std::string& name, Wire& wire) {
    const auto spoil = [&](const auto& bad) {
      if (Chosen(name)) wire = static_cast<Wire>(bad);
    };
    if constexpr (std::is_same_v<Value, bool> || std::is_same_v<Rule, rules::Boolean>) {
      for (const int bad : {2, -1}) spoil(bad);
    } else if constexpr (std::is_enum_v<Value> && std::is_integral_v<Wire>) {
      for (const int bad : {-1, kNumEnumValues<Value>}) spoil(bad);
    } else if constexpr (std::is_floating_point_v<Wire>) {
      for (const double bad : {std::nan(""), kInfinity, -kInfinity, -1.0, 0.0, 0.5, 1.5, 1e300}) {
        if (!Rule::Ok(bad)) spoil(bad);
      }
    } else if constexpr (std::is_integral_v<Wire>) {
      for (const std::int64_t bad : {-2, -1, 0}) {
        if (!Rule::Ok(bad)) spoil(bad);
      }
    } else if constexpr (!std::is_same_v<Value, std::string>) {
      spoil("magic");
    } else if (!Rule::Ok(std::string()) && !(std::is_same_v<Rule, rules::Id> && !path_.empty())) {
      spoil("");
    }
  }

  int which_;
  int count_ = 0;
  std::string path_;
  std::string place_;
};

/// Gives one list of an lcmt_ struct an element more, with every list that shares its count.
class Stretcher {
 public:
  static constexpr bool kReads = false;

  /// Stretches the lists of the `which`-th count, from 0.
  explicit Stretcher(int which) : which_(which) {}
  bool done() const { return chosen_ != nullptr; }

  void Utime(std::int64_t&) {}
  template <typename Value, typename Wire, typename Rule = rules::Anything>
  void Field(const char*, Value& value, Wire& wire, Rule = {}) {
    if constexpr (HasFields<Value>) Fields<Value>::List(*this, value, wire);
  }
  template <typename Values, typename Wire, typename Rule = rules::Anything>
  void List(const char*, Values&, std::vector<Wire>& wires, std::int32_t& count, Rule = {}) {
    if constexpr (HasFields<ElementOf<Values>>) {
      ElementOf<Values> unused;
      if (!wires.empty()) Fields<ElementOf<Values>>::List(*this, unused, wires.front());
    }
    if (chosen_ == &count) {
      wires.push_back(wires.back());
    } else if (seen_.insert(&count).second && chosen_ == nullptr && !wires.empty() &&
               next_++ == which_) {
      chosen_ = &count;
      ++count;
      wires.push_back(wires.back());
    }
  }
  template <typename Values, typename Wires, typename Rule = rules::Anything>
  void Beside(const char* name, Values& values, Wires& wires, std::int32_t& count, Rule = {}) {
    if (chosen_ == &count) List(name, values, wires, count);
  }
  template <typename Values, typename Wires>
  void Rows(const char* name, Values& rows, Wires& wires, std::int32_t& count,
            std::int32_t& width) {
    if (chosen_ == &width) {
      for (auto& row : wires) row.emplace_back();  // the encoder reads as many
    }
    List(name, rows, wires, count);
  }
  template <typename Value, typename Wire>
  void Optional(const char*, Value&, Wire& wire, const char*, std::int8_t&) {
    typename Value::value_type unused;
    Fields<typename Value::value_type>::List(*this, unused, wire);
  }
  template <typename... Args>
  void Require(bool, const char*, const char*, const Args&...) {}

 private:
  int which_;
  int next_ = 0;
  const std::int32_t* chosen_ = nullptr;
  std::set<const std::int32_t*> seen_;
};

/// Collects the members of an lcmt_ struct that a list names; not those of structs inside.
class MemberCollector {
 public:
  static constexpr bool kReads = false;

  std::size_t count() const { return members_.size(); }

  void Utime(std::int64_t& wire) { members_.insert(&wire); }
  template <typename Value, typename Wire, typename Rule = rules::Anything>
  void Field(const char*, Value&, Wire& wire, Rule = {}) {
    members_.insert(&wire);
  }
  template <typename Values, typename Wires, typename Rule = rules::Anything>
  void List(const char*, Values&, Wires& wires, std::int32_t& count, Rule = {}) {
    members_.insert({&wires, &count});
  }
  template <typename Values, typename Wires, typename Rule = rules::Anything>
  void Beside(const char* name, Values& values, Wires& wires, std::int32_t& count, Rule = {}) {
    List(name, values, wires, count);
  }
  template <typename Values, typename Wires>
  void Rows(const char* name, Values& rows, Wires& wires, std::int32_t& count,
            std::int32_t& width) {
    List(name, rows, wires, count);
    members_.insert(&width);
  }
  template <typename Value, typename Wire>
  void Optional(const char*, Value&, Wire& wire, const char*, std::int8_t&) {
    members_.insert(&wire);
  }
  template <typename... Args>
  void Require(bool, const char*, const char*, const Args&...) {}

 private:
  std::set<const void*> members_;
};

/// What any member of an aggregate can be initialised with, as long as it is not run.
struct AnyValue {
  template <typename Value>
  operator Value() const;  // NOLINT(google-explicit-constructor)
};
/// Number of members of an aggregate: of how many values it can be initialised.
template <typename Aggregate, typename... Values>
constexpr std::size_t NumMembers() {
  if constexpr (requires { Aggregate{Values{}..., AnyValue{}}; }) {
    return NumMembers<Aggregate, Values..., AnyValue>();
  } else {
    return sizeof...(Values);
  }
}

}  // namespace planbench
