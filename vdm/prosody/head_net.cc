#include "vdm/prosody/head_net.h"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>

#include "vdm/net/word_lines.h"

namespace vdm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20, kMaxLayers = 4;
constexpr float kMaxUnits = 1024, kLeastScale = 1e-4F;

template <std::size_t N>
vm::Result<void> ReadNumbers(WordLines& lines, std::string_view key, std::array<float, N>& out) {
  const auto numbers = lines.Numbers(key, N);
  if (!numbers) return std::unexpected(numbers.error());
  std::ranges::copy(*numbers, out.begin());
  return {};
}

vm::Result<std::size_t> Count(const WordLines& lines, std::string_view word) {
  const auto number = lines.Number(word);
  if (!number) return std::unexpected(number.error());
  if (*number < 1 || *number > kMaxUnits ||
      *number != static_cast<float>(static_cast<int>(*number))) {
    return lines.Wrong(fmt::format("'{}' found, 1 to {} units expected", word, kMaxUnits));
  }
  return static_cast<std::size_t>(*number);
}

vm::Result<TimeDelayLayer> ReadLayer(WordLines& lines, const std::vector<std::string_view>& head) {
  if (head.size() != 4 || head[0] != "layer" || (head[3] != "relu" && head[3] != "linear")) {
    return lines.Wrong("layer INPUTS OUTPUTS relu|linear expected");
  }
  const auto inputs = Count(lines, head[1]);
  if (!inputs) return std::unexpected(inputs.error());
  const auto outputs = Count(lines, head[2]);
  if (!outputs) return std::unexpected(outputs.error());
  TimeDelayLayer layer{.offsets = {0}, .inputs = *inputs, .rectified = head[3] == "relu"};
  layer.weights.resize(static_cast<Eigen::Index>(*outputs), static_cast<Eigen::Index>(*inputs));
  layer.biases.resize(static_cast<Eigen::Index>(*outputs));
  for (Eigen::Index row = 0; row < layer.biases.size(); ++row) {
    const auto numbers = lines.Numbers("row", *inputs + 1);
    if (!numbers) return std::unexpected(numbers.error());
    layer.biases[row] = numbers->front();
    for (Eigen::Index i = 0; i < layer.weights.cols(); ++i) {
      layer.weights(row, i) = (*numbers)[static_cast<std::size_t>(i) + 1];
    }
  }
  return layer;
}

}  // namespace

vm::Result<HeadNet> ParseHeadNet(const std::string& name, std::string_view text) {
  WordLines lines(name, text);
  if (text.size() > kMaxBytes) return lines.Wrong("longer than 1 MiB");
  HeadNet out;
  const auto sounds = lines.Numbers("sounds", 1);
  if (!sounds) return std::unexpected(sounds.error());
  if (sounds->front() != 0) {
    const auto count = Count(lines, fmt::format("{}", sounds->front()));
    if (!count) return std::unexpected(count.error());
    out.sounds = *count;
  }
  if (auto read = ReadNumbers(lines, "means", out.means); !read) {
    return std::unexpected(read.error());
  }
  if (auto read = ReadNumbers(lines, "scales", out.scales); !read) {
    return std::unexpected(read.error());
  }
  if (std::ranges::any_of(out.scales, [](float s) { return s < kLeastScale; })) {
    return lines.Wrong("a scale below 0.0001 found");
  }
  if (auto read = ReadNumbers(lines, "pose", out.pose); !read) return std::unexpected(read.error());
  for (auto words = lines.Next(); !words.empty(); words = lines.Next()) {
    if (out.net.layers.size() == kMaxLayers) return lines.Wrong("more than 4 layers found");
    auto layer = ReadLayer(lines, words);
    if (!layer) return std::unexpected(layer.error());
    const std::size_t below =
        out.net.layers.empty() ? HeadNet::Inputs(out.sounds) : out.net.outputs();
    if (layer->inputs != below) {
      return lines.Wrong(
          fmt::format("a layer of {} inputs ends here, {} expected", layer->inputs, below));
    }
    out.net.layers.push_back(std::move(*layer));
  }
  if (out.net.layers.empty()) return lines.Wrong("no layer found, at least one expected");
  if (out.net.outputs() != HeadNet::kOutputs) {
    return lines.Wrong(fmt::format("the last layer has {} outputs, {} expected", out.net.outputs(),
                                   HeadNet::kOutputs));
  }
  return out;
}

std::string FormatHeadNet(const HeadNet& net) {
  const auto numbers = [](const auto& values) {
    return fmt::format("{}", fmt::join(values | std::views::transform(NumberText), " "));
  };
  std::string text = fmt::format("sounds {}\n", net.sounds) + "means " + numbers(net.means) +
                     "\nscales " + numbers(net.scales) + "\npose " + numbers(net.pose) + "\n";
  for (const TimeDelayLayer& layer : net.net.layers) {
    text += fmt::format("layer {} {} {}\n", layer.inputs, layer.outputs(),
                        layer.rectified ? "relu" : "linear");
    for (Eigen::Index row = 0; row < layer.weights.rows(); ++row) {
      text += "row " + NumberText(layer.biases[row]);
      for (const float weight : layer.weights.row(row)) text += " " + NumberText(weight);
      text += '\n';
    }
  }
  return text;
}

}  // namespace vdm
