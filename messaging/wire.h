#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "messaging/codec.h"
#include "planbench/lcmt_joint_goal.hpp"
#include "planbench/lcmt_joint_state.hpp"
#include "planbench/lcmt_key_value.hpp"
#include "planbench/lcmt_node_status.hpp"
#include "planbench/lcmt_path.hpp"
#include "planbench/lcmt_path_check_reply.hpp"
#include "planbench/lcmt_plan_request.hpp"
#include "planbench/lcmt_plan_result.hpp"

/// What the codec_*.cc share: the checks of a field, and the conversions of structs that several
/// messages hold. Naming: ToWire(value) makes an lcmt_ struct, FromWire(struct, at) checks one and
/// makes the value; `at` says where it stands.
namespace planbench::wire {

/// Place of a field in a message, for error messages. A chain on the stack: a child must not
/// outlive its parent. No text is made unless something is wrong.
class Field {
 public:
  /// The message itself.
  Field(const std::string& channel, const std::string& request_id)
      : channel_(&channel), request_id_(&request_id) {}

  /// A member, or one element of it.
  Field operator()(const char* name) const { return Field(*this, name, -1); }
  Field operator()(const char* name, std::size_t index) const {
    return Field(*this, name, static_cast<std::int64_t>(index));
  }

  /// Throws MessageError "<channel>: path.to.field[3]: what".
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  Field(const Field& parent, const char* name, std::int64_t index)
      : channel_(parent.channel_),
        request_id_(parent.request_id_),
        parent_(&parent),
        name_(name),
        index_(index) {}
  std::string Path() const;

  const std::string* channel_;
  const std::string* request_id_;
  const Field* parent_ = nullptr;
  const char* name_ = nullptr;
  std::int64_t index_ = -1;
};

// Checks of single fields; each returns the value.
double Finite(double value, const Field& at);
double NonNegative(double value, const Field& at);  ///< And finite.
double Positive(double value, const Field& at);     ///< And finite.
double Fraction(double value, const Field& at);     ///< In [0, 1].
std::int64_t AtLeast(std::int64_t minimum, std::int64_t value, const Field& at);
bool Bool(std::int8_t value, const Field& at);
const std::string& NotEmpty(const std::string& text, const Field& at);
CollisionModel Model(const std::string& name, const Field& at);
EdgeCheck Method(const std::string& name, const Field& at);
template <typename Enum>
Enum EnumOf(std::int8_t value, const Field& at) {
  if (value < 0 || value >= kNumEnumValues<Enum>) {
    at.Fail("no such value: " + std::to_string(value));
  }
  return static_cast<Enum>(value);
}
/// Throws unless all are different and none is empty.
const std::vector<std::string>& Names(const std::vector<std::string>& names, const Field& parent,
                                      const char* name);

/// The count of a list; throws std::logic_error if it does not fit.
std::int32_t Count(std::size_t size);
/// Throws std::logic_error, naming the list, unless the sizes are equal.
void RequireSameSize(std::size_t a, std::size_t b, const char* what);

std::vector<lcmt_key_value> ToWire(const std::map<std::string, std::string>& values);
std::map<std::string, std::string> FromWire(const std::vector<lcmt_key_value>& values,
                                            const Field& parent, const char* name);
lcmt_joint_state ToWire(const JointState& state);
JointState FromWire(const lcmt_joint_state& state, const Field& at);
std::vector<lcmt_joint_goal> ToWire(const std::vector<JointGoal>& goal);
std::vector<JointGoal> FromWire(const std::vector<lcmt_joint_goal>& goal, const Field& parent,
                                const char* name);
/// A path without waypoints loses its joint names.
lcmt_path ToWire(const std::vector<std::string>& joint_names, const Path& path);
struct NamedPath {
  std::vector<std::string> joint_names;
  Path path;
};
NamedPath FromWire(const lcmt_path& path, const Field& at);

// Messages that stand inside others too. There they may be empty: ids are required by Decode only.
lcmt_plan_request ToWire(const PlanRequest& request);
PlanRequest FromWire(const lcmt_plan_request& request, const Field& at);
lcmt_plan_result ToWire(const PlanResultMessage& result);
PlanResultMessage FromWire(const lcmt_plan_result& result, const Field& at);
lcmt_path_check_reply ToWire(const PathCheckReplyMessage& reply);
PathCheckReplyMessage FromWire(const lcmt_path_check_reply& reply, const Field& at);
lcmt_node_status ToWire(const NodeStatusMessage& status);
NodeStatusMessage FromWire(const lcmt_node_status& status, const Field& at);

/// Bytes of an lcmt_ struct, its type's fingerprint first.
template <typename Wire>
std::vector<std::uint8_t> Pack(const Wire& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  if (size < 0) throw std::logic_error(std::string(Wire::getTypeName()) + ": cannot be encoded");
  bytes.resize(static_cast<std::size_t>(size));  // Text ends at its first NUL on the wire.
  return bytes;
}

/// The lcmt_ struct in `bytes`; throws MessageError for another type, truncation, excess.
template <typename Wire>
Wire Unpack(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const std::string no_id;
  const Field at(channel, no_id);
  const std::string type = Wire::getTypeName();
  std::int64_t fingerprint = 0;
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    at.Fail("too large for a " + type);
  }
  const int size = static_cast<int>(bytes.size());
  if (__int64_t_decode_array(bytes.data(), 0, size, &fingerprint, 1) < 0) {
    at.Fail("too short for a " + type);
  }
  if (fingerprint != Wire::getHash()) at.Fail("not a " + type + " of this version");
  Wire message{};
  int used = -1;
  try {
    used = message.decode(bytes.data(), 0, size);
  } catch (const std::length_error&) {  // A count that no memory could hold.
  } catch (const std::bad_alloc&) {
  }
  if (used < 0) at.Fail("truncated or damaged " + type);
  if (used != size) {
    at.Fail(std::to_string(size - used) + " bytes after the end of the " + type);
  }
  return message;
}

}  // namespace planbench::wire
