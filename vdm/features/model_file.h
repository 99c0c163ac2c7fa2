#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace vdm {

inline constexpr std::size_t kMostModelBytes = std::size_t{64} << 20;

/// Little-endian numbers out of a file of the model.
class ModelFile {
 public:
  static vm::Result<ModelFile> Open(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const std::streamoff size = file.tellg();
    if (!file || size < 0) {
      return vm::Fail(vm::Errc::kUnavailable,
                      "cannot read '" + path + "' (Debian: pocketsphinx-en-us)");
    }
    ModelFile out;
    out.path_ = path;
    if (static_cast<std::size_t>(size) > kMostModelBytes) return out.Wrong("longer than 64 MiB");
    out.bytes_.resize(static_cast<std::size_t>(size));
    file.seekg(0);
    file.read(out.bytes_.data(), size);
    out.bytes_.resize(static_cast<std::size_t>(file.gcount()));
    return out;
  }
  std::unexpected<vm::Error> Wrong(const std::string& what) const {
    return vm::Fail(vm::Errc::kBadValue, path_ + ": " + what);
  }
  bool ok() const { return ok_; }
  std::string Text(std::size_t count) { return std::string(View(count)); }
  /// As long as the file is there.
  std::string_view View(std::size_t count) {
    if (bytes_.size() - at_ < count) ok_ = false;
    const auto text = ok_ ? std::string_view(bytes_).substr(at_, count) : std::string_view();
    if (ok_) at_ += count;
    return text;
  }
  template <typename T>
  T Value() {
    T value{};
    const std::string_view text = View(sizeof value);
    if (ok_) std::memcpy(&value, text.data(), sizeof value);
    return value;
  }
  std::size_t Count() { return Value<std::uint32_t>(); }
  /// Up to a zero.
  std::string Word() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) ok_ = false;
    std::string word = ok_ ? Text(end - at_) : std::string();
    Text(1);
    return word;
  }
  bool Skip(std::string_view end) {
    const std::size_t found = bytes_.find(end, at_);
    ok_ = ok_ && found != std::string::npos;
    if (ok_) at_ = found + end.size();
    return ok_;
  }
  /// On to the last part of the file that stands behind its own length.
  bool SkipToTail() {
    for (std::size_t at = bytes_.size(); ok_ && at >= at_ + sizeof(std::uint32_t); --at) {
      std::uint32_t length = 0;
      std::memcpy(&length, bytes_.data() + at - sizeof length, sizeof length);
      if (length == 0 || length != bytes_.size() - at) continue;
      at_ = at;
      return true;
    }
    return ok_ = false;
  }

 private:
  std::string path_, bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace vdm
