// The same bytes give the same lines whole and in pieces, in every framing.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/line_framing.h"

namespace {

std::vector<std::string> Lines(std::string_view bytes, std::size_t step, vm::Framing framing) {
  vm::LineReader reader(framing);
  std::vector<std::string> lines;
  const auto take = [&lines](vm::Result<std::string_view> line) {
    lines.push_back(line ? std::string(*line) : "\n" + line.error().text);
  };
  for (std::size_t at = 0; at < bytes.size(); at += step) reader.Feed(bytes.substr(at, step), take);
  reader.End(take);
  return lines;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto framing = static_cast<vm::Framing>(data[0] % 3);
  const std::size_t step = 1 + data[1] % 16;
  const std::string_view bytes(reinterpret_cast<const char*>(data + 2), size - 2);
  if (Lines(bytes, step, framing) != Lines(bytes, size, framing)) std::abort();
  return 0;
}
