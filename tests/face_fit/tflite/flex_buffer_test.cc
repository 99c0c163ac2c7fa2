#include "face_fit/tflite/flex_buffer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace facefit::tflite {
namespace {

/// {"a": 0.5, "b": [300, 7], "c": -2} as FlexBuffers lays it out. Offsets count backwards.
std::vector<std::uint8_t> SmallMap() {
  return {// clang-format off
          'a', 0, 'b', 0, 'c', 0,               // 0: the keys
          2, 0, 0x2c, 1, 7, 0,                  // 6: the list of two bytes each, its count before it
          3, 13, 12, 11,                        // 12: count of the keys, and offsets to them
          3, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0,   // 16: offset to the keys at 13, their width, the count
          0, 0, 0, 0x3f,                        // 28: 0.5
          24, 0, 0, 0,                          // 32: offset to the list at 8
          0xfe, 0xff, 0xff, 0xff,               // 36: -2
          3 << 2 | 2, 11 << 2 | 1, 1 << 2 | 2,  // 40: types of the three values
          15, 9 << 2 | 2, 1};                   // 43: offset to the map at 28, its type; a byte wide
  // clang-format on
}

TEST(FlexMapTest, ReadsNumbersAndLists) {
  const auto bytes = SmallMap();
  const FlexMap map = FlexMap::Root(bytes);
  EXPECT_EQ(map.Number("a"), 0.5);
  EXPECT_EQ(map.Integers("b"), (std::vector<std::int64_t>{300, 7}));
  EXPECT_EQ(map.Integer("c"), -2);
  EXPECT_EQ(map.Number("c"), -2);
  EXPECT_THROW(map.Integer("d"), BadModel);
  EXPECT_THROW(map.Integer("a"), BadModel);
  EXPECT_THROW(map.Integers("a"), BadModel);
}

TEST(FlexMapTest, DamagedBytesAreRefusedOrReadAsSomethingElse) {
  const auto bytes = SmallMap();
  const auto read = [](const std::vector<std::uint8_t>& from) {
    try {
      const FlexMap map = FlexMap::Root(from);
      map.Number("a");
      map.Integers("b");
      map.Integer("c");
    } catch (const BadModel&) {
    }
  };
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    read({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)});
    for (const int other : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      auto changed = bytes;
      changed[n] = static_cast<std::uint8_t>(other);
      read(changed);
    }
  }
  EXPECT_THROW(FlexMap::Root({}), BadModel);
}

}  // namespace
}  // namespace facefit::tflite
