#include <gtest/gtest.h>

#include <random>

#include "messaging/wire.h"
#include "tests/messaging/allocation_meter.h"
#include "tests/messaging/codec_fixture.h"

namespace planbench {
namespace {

// What comes off a network may be damaged in any way. Decode must refuse it or return a message,
// and must not take more memory than a small multiple of its size.

constexpr std::size_t kFingerprintSize = 8;

/// Damages the bytes behind the fingerprint: flips bits, writes numbers that counts and lengths
/// could choke on, cuts, repeats.
class Damage {
 public:
  explicit Damage(std::uint32_t seed) : random_(seed) {}

  void Apply(std::vector<std::uint8_t>* bytes) {
    const int times = Pick(1, 4);
    for (int i = 0; i < times; ++i) {
      switch (Pick(0, 4)) {
        case 0:
          (*bytes)[Place(*bytes)] ^= static_cast<std::uint8_t>(1 << Pick(0, 7));
          break;
        case 1:
          (*bytes)[Place(*bytes)] = static_cast<std::uint8_t>(Pick(0, 255));
          break;
        case 2: {
          constexpr std::array<std::uint32_t, 8> kNumbers = {
              0, 1, 0xffffffff, 0x7fffffff, 0x80000000, 0x10000000, 1000, 60};
          const std::uint32_t number = kNumbers[static_cast<std::size_t>(Pick(0, 7))];
          const std::size_t place = Place(*bytes);
          for (std::size_t j = 0; j < 4 && place + j < bytes->size(); ++j) {
            (*bytes)[place + j] = static_cast<std::uint8_t>(number >> (24 - 8 * j));
          }
          break;
        }
        case 3:
          bytes->resize(Place(*bytes) + 1);
          break;
        default: {
          const std::size_t place = Place(*bytes);
          const std::vector<std::uint8_t> tail(bytes->begin() + static_cast<std::ptrdiff_t>(place),
                                               bytes->end());
          bytes->insert(bytes->end(), tail.begin(), tail.end());
        }
      }
    }
  }

 private:
  int Pick(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  std::size_t Place(const std::vector<std::uint8_t>& bytes) {
    return static_cast<std::size_t>(Pick(
        kFingerprintSize, std::max<int>(kFingerprintSize, static_cast<int>(bytes.size()) - 1)));
  }

  std::mt19937 random_;
};

template <typename Message>
class DamagedMessage : public CodecTest {};
TYPED_TEST_SUITE(DamagedMessage, AllMessages);

TYPED_TEST(DamagedMessage, IsRefusedOrRead) {
  const std::vector<std::uint8_t> original = Encode(Example<TypeParam>());
  Damage damage(20240611);
  int num_refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint8_t> bytes = original;
    damage.Apply(&bytes);
    const AllocationMeter meter;
    try {
      Decode<TypeParam>(bytes, "CH");
    } catch (const MessageError&) {
      ++num_refused;
    }
    ASSERT_LT(meter.Peak(), 64 * bytes.size() + 65536);
  }
  EXPECT_GT(num_refused, 0);
}

// A large message that consists of nothing but a count is the worst case.
TEST(LargeCounts, TakeNoMoreThanTheMessageCouldHold) {
  const auto refuse_all_counts = [](auto type, std::size_t message_size) {
    using Wire = decltype(type);
    const auto prototype = wire::Pack(Wire{});
    for (std::size_t place = kFingerprintSize; place + 4 <= prototype.size(); ++place) {
      for (const std::size_t divisor : {1, 5, 9, 16, 64, 200}) {
        std::vector<std::uint8_t> bytes = prototype;
        bytes.resize(message_size, 0);
        const std::size_t number = message_size / divisor - 100;
        for (std::size_t j = 0; j < 4; ++j) {
          bytes[place + j] = static_cast<std::uint8_t>(number >> (24 - 8 * j));
        }
        const AllocationMeter meter;
        EXPECT_THROW(wire::Unpack<Wire>(bytes, "CH"), MessageError);
        ASSERT_LT(meter.Peak(), 20 * message_size) << "at byte " << place;
      }
    }
  };
  refuse_all_counts(lcmt_session{}, 100000);
  refuse_all_counts(lcmt_scene{}, 100000);
  refuse_all_counts(lcmt_path{}, 100000);
  refuse_all_counts(lcmt_plan_result{}, 100000);
  refuse_all_counts(lcmt_node_status{}, 100000);
}

}  // namespace
}  // namespace planbench
