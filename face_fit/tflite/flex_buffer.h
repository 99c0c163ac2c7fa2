#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "face_fit/tflite/flat_buffer.h"

namespace facefit::tflite {

/// A map of a FlexBuffer (google/flatbuffers, "FlexBuffers: internals"), in which TensorFlow Lite
/// keeps the options of custom operators. Values are whole numbers, floating-point numbers, and
/// vectors of whole numbers. Every access is checked against the bytes' ends; throws BadModel.
/// Lifetime: looks into `bytes`, which must outlive it.
class FlexMap {
 public:
  static FlexMap Root(Bytes bytes);

  /// Throws BadModel if the map has no such key, or a value of another kind. Numbers are finite.
  std::int64_t Integer(std::string_view key) const;
  double Number(std::string_view key) const;
  std::vector<std::int64_t> Integers(std::string_view key) const;

 private:
  struct Value {
    std::size_t at;     ///< offset of the number, or where its offset counts from
    std::size_t width;  ///< bytes of the number or of the offset
    unsigned type;      ///< as packed: the kind above two bits of the width of what it points to
  };
  FlexMap(Bytes bytes, const Value& map);
  Value Find(std::string_view key) const;

  Bytes bytes_;
  std::size_t values_ = 0, width_ = 0, count_ = 0;
};

}  // namespace facefit::tflite
