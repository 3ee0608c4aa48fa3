#pragma once

#include <map>
#include <string>
#include <type_traits>
#include <utility>

/// Every field of a message is written once, in a list:
///
///   template <>
///   struct Fields<PlanAckMessage> : On<lcmt_plan_ack> {
///     static void List(auto& io, auto& v, auto& w) {
///       io.Utime(w.utime);
///       io.Field("request_id", v.request_id, w.request_id, kId);
///       io.Field("verdict", v.verdict, w.verdict);
///       ...
///
/// The archive `io` decides what is done with it: Encoder fills `wire` from `value`, Decoder checks
/// `wire` and fills `value` from it, Printer writes `wire` as text. An archive has
///
///   kReads                                   whether it fills `value`
///   Utime(wire)                              the moment of sending, where it is not in `value`
///   Field(name, value, wire [, rule])        one value, of a type with a list of its own or not
///   List(name, values, wires, count [, rule])
///   Beside(name, values, wires, count [, rule])  a list as long as one before, with its count
///   Rows(name, rows, wires, count, width)    lists of one length; `width` is a field before
///   Optional(name, value, wire, flag_name, flag)  `wire` is nothing unless its `flag` is set
///   Require(ok, name, what, arguments...)    a rule over several fields; only Decoder looks at it
///
/// Names are those of lcmtypes/, rules those of field_rules.h. Where what is sent is not what the
/// value holds, the list goes over a local variable in between, made from the value unless kReads
/// and turned into the value if kReads.
namespace planbench {

template <typename Value>
struct Fields;

template <typename LcmType>
struct On {
  using Wire = LcmType;
};

template <typename Value>
concept HasFields = requires {
  typename Fields<std::remove_const_t<Value>>::Wire;
};

/// With Key(value) and kKey, the name of that field: no two elements of a list may have one key.
template <typename Value>
concept HasKey = requires {
  Fields<Value>::kKey;
};

/// What a list or map holds.
template <typename List>
struct Element {
  using Type = typename List::value_type;
};
template <typename Value>
struct Element<std::map<std::string, Value>> {
  using Type = std::pair<std::string, Value>;
};
template <typename List>
using ElementOf = typename Element<std::remove_const_t<List>>::Type;

}  // namespace planbench
