#include "face_fit/tflite/flex_buffer.h"

#include <cmath>

namespace facefit::tflite {
namespace {

// Kinds of values, as flexbuffers.h of google/flatbuffers numbers them.
enum : unsigned { kInt = 1, kUint = 2, kFloat = 3, kMap = 9, kVectorInt = 11, kVectorUint = 12 };

unsigned Kind(unsigned packed) { return packed >> 2; }
std::size_t TargetWidth(unsigned packed) { return std::size_t{1} << (packed & 3U); }

bool IsWidth(std::uint64_t bytes) { return bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8; }

/// Returns a whole number of `width` bytes. REQUIRES: IsWidth(width).
template <typename Result, typename One, typename Two, typename Four>
Result ReadWhole(Bytes bytes, std::size_t at, std::size_t width) {
  switch (width) {
    case 1:
      return Read<One>(bytes, at);
    case 2:
      return Read<Two>(bytes, at);
    case 4:
      return Read<Four>(bytes, at);
    default:
      return Read<Result>(bytes, at);
  }
}
constexpr auto ReadUnsigned = ReadWhole<std::uint64_t, std::uint8_t, std::uint16_t, std::uint32_t>;
constexpr auto ReadSigned = ReadWhole<std::int64_t, std::int8_t, std::int16_t, std::int32_t>;

/// Returns where an offset at `at` points to: offsets count backwards.
std::size_t Behind(Bytes bytes, std::size_t at, std::size_t width) {
  const std::uint64_t back = ReadUnsigned(bytes, at, width);
  if (back > at) throw BadModel("an operator's options point outside themselves");
  return at - static_cast<std::size_t>(back);
}

/// Returns the number of items of a vector, which is stored before the first.
std::size_t Count(Bytes bytes, std::size_t first, std::size_t width) {
  if (first < width) throw BadModel("an operator's options point outside themselves");
  const std::uint64_t count = ReadUnsigned(bytes, first - width, width);
  if (count > (bytes.size() - first) / width) {
    throw BadModel("a list of an operator's options is longer than they are");
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

FlexMap FlexMap::Root(Bytes bytes) {
  if (bytes.size() < 3) throw BadModel("an operator lacks its options");
  const std::size_t width = bytes[bytes.size() - 1];
  if (!IsWidth(width) || bytes.size() < width + 2) {
    throw BadModel("an operator's options are damaged");
  }
  return {bytes, {bytes.size() - 2 - width, width, bytes[bytes.size() - 2]}};
}

FlexMap::FlexMap(Bytes bytes, const Value& map) : bytes_(bytes) {
  if (Kind(map.type) != kMap) throw BadModel("an operator's options are no map");
  values_ = Behind(bytes, map.at, map.width);
  width_ = TargetWidth(map.type);
  count_ = Count(bytes, values_, width_);
  if (values_ < 3 * width_) throw BadModel("an operator's options are damaged");
}

FlexMap::Value FlexMap::Find(std::string_view key) const {
  // Before the number of values: where the keys are and the width of their offsets.
  const std::size_t keys = Behind(bytes_, values_ - 3 * width_, width_);
  const std::uint64_t width = ReadUnsigned(bytes_, values_ - 2 * width_, width_);
  if (!IsWidth(width)) {
    throw BadModel("an operator's options are damaged");
  }
  const auto step = static_cast<std::size_t>(width);
  for (std::size_t i = 0; i < count_; ++i) {
    const std::size_t name = Behind(bytes_, keys + i * step, step);
    if (bytes_.size() - name <= key.size()) continue;
    const Bytes text = bytes_.subspan(name, key.size() + 1);
    if (text.back() != 0 || std::memcmp(text.data(), key.data(), key.size()) != 0) continue;
    return {values_ + i * width_, width_,
            Read<std::uint8_t>(bytes_, values_ + count_ * width_ + i)};
  }
  throw BadModel("an operator's options lack '" + std::string(key) + "'");
}

std::int64_t FlexMap::Integer(std::string_view key) const {
  const Value value = Find(key);
  if (Kind(value.type) == kInt) return ReadSigned(bytes_, value.at, value.width);
  if (Kind(value.type) == kUint) {
    return static_cast<std::int64_t>(ReadUnsigned(bytes_, value.at, value.width));
  }
  throw BadModel("the option '" + std::string(key) + "' is no whole number");
}

double FlexMap::Number(std::string_view key) const {
  const Value value = Find(key);
  if (Kind(value.type) != kFloat) return static_cast<double>(Integer(key));
  double number = NAN;
  if (value.width == 4) number = static_cast<double>(Read<float>(bytes_, value.at));
  if (value.width == 8) number = Read<double>(bytes_, value.at);
  if (!std::isfinite(number)) throw BadModel("the option '" + std::string(key) + "' is no number");
  return number;
}

std::vector<std::int64_t> FlexMap::Integers(std::string_view key) const {
  const Value value = Find(key);
  const unsigned kind = Kind(value.type);
  if (kind != kVectorInt && kind != kVectorUint) {
    throw BadModel("the option '" + std::string(key) + "' is no list of whole numbers");
  }
  const std::size_t first = Behind(bytes_, value.at, value.width);
  const std::size_t width = TargetWidth(value.type);
  const std::size_t count = Count(bytes_, first, width);
  std::vector<std::int64_t> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = first + i * width;
    numbers.push_back(kind == kVectorInt
                          ? ReadSigned(bytes_, at, width)
                          : static_cast<std::int64_t>(ReadUnsigned(bytes_, at, width)));
  }
  return numbers;
}

}  // namespace facefit::tflite
