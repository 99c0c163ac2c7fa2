// A TensorFlow Lite file of a small network with bytes changed: what is read becomes a network or
// is refused, and a network that was made runs once. An input that begins as such a file is taken
// as it is; any other holds changes of three bytes each: where (two bytes, wrapped round), and what
// stands there then. No changes: the whole file.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "face_fit/tflite/network.h"
#include "tests/face_fit/tflite/tflite_maker.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr double kMaxWork = 1e6;
  constexpr std::size_t kMaxNumbers = 1 << 20;
  static const std::string kWhole = facefit::tflite::maker::EveryOperator();
  std::string file = kWhole;
  if (size >= 8 && std::string(data + 4, data + 8) == "TFL3") {
    file.assign(data, data + size);
  } else {
    for (; size >= 3; data += 3, size -= 3) {
      const auto at = static_cast<std::size_t>(data[0] | data[1] << 8);
      file[at % file.size()] = static_cast<char>(data[2]);
    }
  }
  // As the kernels get it: a copy whose end the sanitizer knows.
  const std::vector<std::uint8_t> bytes(file.begin(), file.end());
  try {
    facefit::tflite::Model model = facefit::tflite::Model::Read(bytes);
    std::size_t numbers = 0;  // memory is bounded, but slow to clear so often
    for (const facefit::tflite::Tensor& tensor : model.tensors) numbers += tensor.shape.count();
    if (numbers > kMaxNumbers) return 0;
    facefit::tflite::Network network(std::move(model), kMaxWork);
    network.Run(std::vector<float>(network.input_shape().count(), 0.5F));
    for (std::size_t i = 0; i < network.outputs(); ++i) (void)network.output(i);
  } catch (const facefit::tflite::BadModel& refused) {
    if (file == kWhole) __builtin_trap();
  }
  return 0;
}
