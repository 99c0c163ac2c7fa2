#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>

namespace facefit::tflite {

/// Thrown if bytes do not hold what they should.
class BadModel : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Bytes = std::span<const std::uint8_t>;

/// Returns a number at an offset in a file; throws BadModel beyond the file's end.
template <typename T>
T Read(Bytes file, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  if (at > file.size() || file.size() - at < sizeof(T)) {
    throw BadModel("the file ends too early");
  }
  T value;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

/// A table of a FlatBuffer (google/flatbuffers, "Internals"): fields are found through a table of
/// offsets before them. Every access is checked against the file's end; throws BadModel.
class FlatTable {
 public:
  static FlatTable Root(Bytes file) { return {file, Read<std::uint32_t>(file, 0)}; }

  FlatTable(Bytes file, std::size_t at) : file_(file), at_(at) {
    const auto back = Read<std::int32_t>(file, at);
    const auto fields = static_cast<std::int64_t>(at) - back;
    if (fields < 0 || fields > static_cast<std::int64_t>(file.size())) {
      throw BadModel("a table's list of fields lies outside the file");
    }
    fields_ = static_cast<std::size_t>(fields);
    field_bytes_ = Read<std::uint16_t>(file, fields_);
  }

  template <typename T>
  T Scalar(std::size_t field, T otherwise) const {
    const std::size_t at = OffsetOf(field);
    return at == 0 ? otherwise : Read<T>(file_, at);
  }

  /// Returns a vector of scalars; empty if absent. The bytes need not be aligned.
  Bytes Vector(std::size_t field, std::size_t item_bytes) const {
    const std::size_t at = OffsetOf(field);
    if (at == 0) return {};
    const std::size_t start = at + Read<std::uint32_t>(file_, at);
    const std::size_t count = Read<std::uint32_t>(file_, start);
    if (count > (file_.size() - start - 4) / item_bytes) {
      throw BadModel("a vector ends beyond the file");
    }
    return file_.subspan(start + 4, count * item_bytes);
  }

  std::size_t TableCount(std::size_t field) const { return Vector(field, 4).size() / 4; }
  FlatTable TableAt(std::size_t field, std::size_t index) const {
    const Bytes items = Vector(field, 4);
    if (index >= items.size() / 4) throw BadModel("a list of tables is too short");
    const auto here = static_cast<std::size_t>(items.data() - file_.data()) + 4 * index;
    return {file_, here + Read<std::uint32_t>(file_, here)};
  }
  bool Has(std::size_t field) const { return OffsetOf(field) != 0; }
  FlatTable Table(std::size_t field) const {
    const std::size_t at = OffsetOf(field);
    if (at == 0) throw BadModel("a table is missing");
    return {file_, at + Read<std::uint32_t>(file_, at)};
  }
  std::string Text(std::size_t field) const {
    const Bytes text = Vector(field, 1);
    return {text.begin(), text.end()};
  }

 private:
  std::size_t OffsetOf(std::size_t field) const {
    const std::size_t slot = 4 + 2 * field;
    if (slot + 2 > field_bytes_) return 0;
    const auto offset = Read<std::uint16_t>(file_, fields_ + slot);
    return offset == 0 ? 0 : at_ + offset;
  }

  Bytes file_;
  std::size_t at_;
  std::size_t fields_ = 0, field_bytes_ = 0;
};

}  // namespace facefit::tflite
