#include "scene/moveit_octomap_reader.h"

#include <fmt/format.h>
#include <zlib.h>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/octomap.h"
#include "scene/moveit_fields.h"
#include "scene/pose.h"

namespace planbench {
namespace {

// What a map may be once it is unpacked: a full one of three million nodes.
constexpr std::size_t kMostUnpacked = std::size_t{16} << 20;

// The bytes of pairs of hexadecimal digits, nothing for other texts.
std::vector<std::uint8_t> BytesOfHex(const std::string& text) {
  std::vector<std::uint8_t> bytes(text.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char* const digits = text.data() + 2 * i;
    if (std::from_chars(digits, digits + 2, bytes[i], 16).ptr != digits + 2) return {};
  }
  return text.size() % 2 == 0 ? bytes : std::vector<std::uint8_t>();
}

// RFC 1950's header. Bytes that begin so are hardly anything else.
bool IsZlibStream(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() > 2 && (bytes[0] & 0x0f) == Z_DEFLATED &&
         (bytes[0] * 256 + bytes[1]) % 31 == 0;
}

std::vector<std::uint8_t> ReadData(const YamlNode& node) {
  if (!node.IsScalar() || node.IsBinary()) return node.Bytes();
  const std::vector<std::uint8_t> packed = BytesOfHex(node.String());
  if (!IsZlibStream(packed)) {
    node.Fail("expected a sequence of bytes, !!binary, or a zlib stream in hexadecimal digits");
  }
  std::vector<std::uint8_t> bytes(kMostUnpacked);
  uLongf size = bytes.size();
  uLong used = packed.size();
  const int status = uncompress2(bytes.data(), &size, packed.data(), &used);
  if (status == Z_BUF_ERROR) {
    node.Fail(fmt::format("unpacks to more than {} bytes", kMostUnpacked));
  }
  if (status != Z_OK || used != packed.size()) {
    node.Fail("is no whole zlib stream; the data is damaged or cut off");
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

void AddOctomap(const YamlNode& world, const FrameTree& frames, Scene* scene) {
  const std::optional<YamlNode> with_pose = world.Find("octomap");
  const std::optional<YamlNode> octomap = with_pose ? with_pose->Find("octomap") : std::nullopt;
  const std::optional<YamlNode> data = octomap ? octomap->Find("data") : std::nullopt;
  if (!data) return;
  const std::vector<std::uint8_t> bytes = ReadData(*data);
  if (bytes.empty()) return;
  SceneObject object;
  object.id = kOctomapId;
  const std::optional<YamlNode> origin = with_pose->Find("origin");
  object.X_WO = frames.At(ReadFrame(*with_pose), FrameNode(*with_pose));
  if (origin && !IsUnsetPose(*origin)) object.X_WO = object.X_WO * ReadPose(*origin);
  object.X_WO = CanonicalPose(object.X_WO);
  const std::string id = octomap->At("id").String();
  const bool binary = ReadFlag(octomap->At("binary"));
  const double resolution = octomap->At("resolution").PositiveDouble();
  object.shapes = AtField(*data, [&] { return OctomapBoxes(bytes, binary, id, resolution); });
  if (!object.shapes.empty()) scene->objects.push_back(std::move(object));
}

}  // namespace planbench
