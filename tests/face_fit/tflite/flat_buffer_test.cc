#include "face_fit/tflite/flat_buffer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/face_fit/tflite/tflite_maker.h"

namespace facefit::tflite {
namespace {

std::vector<std::uint8_t> TableOf(const maker::Fields& fields) {
  const std::string file = maker::FlatFile(fields).bytes();
  return {file.begin(), file.end()};
}

TEST(FlatTableTest, FieldsAreFoundAndWhatIsLeftOutHasItsDefault) {
  const auto bytes = TableOf({maker::Number(7),
                              {},
                              maker::List({1, 2, 3}),
                              maker::Text("name"),
                              maker::One({maker::Number(8)}),
                              maker::Many({{maker::Number(9)}, {maker::Number(10)}})});
  const FlatTable table = FlatTable::Root(bytes);
  EXPECT_EQ(table.Scalar<std::int32_t>(0, -1), 7);
  EXPECT_EQ(table.Scalar<std::int32_t>(1, -1), -1);
  EXPECT_FALSE(table.Has(1));
  EXPECT_EQ(table.Vector(2, 4).size(), 12U);
  EXPECT_TRUE(table.Vector(1, 4).empty());
  EXPECT_EQ(table.Text(3), "name");
  EXPECT_EQ(table.Table(4).Scalar<std::int32_t>(0, -1), 8);
  ASSERT_EQ(table.TableCount(5), 2U);
  EXPECT_EQ(table.TableAt(5, 1).Scalar<std::int32_t>(0, -1), 10);
  EXPECT_EQ(table.Scalar<std::int32_t>(20, -1), -1) << "a field that the file does not know";
}

TEST(FlatTableTest, WhatIsNotThereIsRefused) {
  const auto bytes = TableOf({maker::Number(7), {}, maker::Many({{maker::Number(9)}})});
  const FlatTable table = FlatTable::Root(bytes);
  EXPECT_THROW(table.Table(1), BadModel);
  EXPECT_THROW(table.TableAt(2, 1), BadModel);
  EXPECT_THROW(FlatTable::Root({}), BadModel);
}

TEST(FlatTableTest, EveryDamagedByteIsRefusedOrReadAsSomethingElse) {
  const auto whole = TableOf({maker::Number(7), maker::List({1, 2, 3}), maker::Text("name"),
                              maker::Many({{maker::Number(9)}})});
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const int other : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      auto bytes = whole;
      bytes[i] = static_cast<std::uint8_t>(other);
      try {
        const FlatTable table = FlatTable::Root(bytes);
        table.Scalar<std::int32_t>(0, 0);
        table.Vector(1, 4);
        table.Text(2);
        for (std::size_t k = 0; k < std::min<std::size_t>(table.TableCount(3), 4); ++k) {
          table.TableAt(3, k).Scalar<std::int32_t>(0, 0);
        }
      } catch (const BadModel&) {
      }
    }
  }
}

}  // namespace
}  // namespace facefit::tflite
