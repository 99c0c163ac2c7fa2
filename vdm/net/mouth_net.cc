#include "vdm/net/mouth_net.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include "vdm/net/word_lines.h"
#include "vm_protocol/runtime/base64.h"

namespace vdm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxLayers = 8, kMaxOffsets = 16, kMaxVector = 1024, kMaxSounds = 64;
constexpr int kMaxOffset = 64, kMaxInteger = 127;
constexpr float kLeastScale = 1e-6F;

/// What is nothing beside the rest, and in the end no number that can be read again.
float WithoutDust(float value) { return std::abs(value) < 1e-30F ? 0 : value; }

bool FeaturesNamed(std::string_view name, FeatureKind& out) {
  for (const FeatureKind kind :
       {FeatureKind::kMel, FeatureKind::kPhones, FeatureKind::kCepstra, FeatureKind::kWords}) {
    if (name != FeatureName(kind)) continue;
    out = kind;
    return true;
  }
  return false;
}

class Reader {
 public:
  Reader(const std::string& name, std::string_view text)
      : lines_(name, text), bytes_(text.size()) {}

  vm::Result<MouthNet> Read() {
    if (bytes_ > kMaxBytes) return Wrong("longer than 4 MiB");
    MouthNet out;
    if (auto words = lines_.Line("features", 1); !words) {
      return std::unexpected(words.error());
    } else if (!FeaturesNamed((*words)[1], out.features)) {
      return Wrong("'" + std::string((*words)[1]) +
                   "' found, mel, phones, cepstra or words expected");
    }
    if (auto words = lines_.Line("sounds"); !words) {
      return std::unexpected(words.error());
    } else if (words->size() < 2 || words->size() > kMaxSounds + 1) {
      return Wrong(fmt::format("{} sounds found, 1 to {} expected", words->size() - 1, kMaxSounds));
    } else {
      out.sounds.assign(words->begin() + 1, words->end());
    }
    if (auto read = Numbers("means", out.means); !read) return std::unexpected(read.error());
    if (auto read = Numbers("scales", out.scales); !read) return std::unexpected(read.error());
    if (std::ranges::any_of(out.scales, [](float s) { return s < kLeastScale; })) {
      return Wrong("a scale below 0.000001 found");
    }
    while (lines_.More()) {
      if (auto read = Layer(out.net); !read) return std::unexpected(read.error());
    }
    return Checked(std::move(out));
  }

 private:
  vm::Result<MouthNet> Checked(MouthNet out) {
    if (out.net.layers.empty()) return Wrong("no layer found, at least one expected");
    const std::size_t inputs = FeatureSize(out.features);
    if (out.net.inputs() != inputs) {
      return Wrong(fmt::format("the first layer has {} inputs, {} features give {}",
                               out.net.inputs(), FeatureName(out.features), inputs));
    }
    const std::size_t outputs = out.first_sound_row() + out.sounds.size();
    if (out.net.outputs() != outputs) {
      return Wrong(
          fmt::format("the last layer has {} outputs, {} expected: {} of the shape, the "
                      "closure and {} sounds",
                      out.net.outputs(), outputs, kShapeNumbers, out.sounds.size()));
    }
    return out;
  }

  std::unexpected<vm::Error> Wrong(const std::string& what) const { return lines_.Wrong(what); }

  vm::Result<void> Numbers(std::string_view key, std::array<float, kShapeNumbers>& out) {
    auto words = lines_.Line(key, kShapeNumbers);
    if (!words) return std::unexpected(words.error());
    for (std::size_t i = 0; i < out.size(); ++i) {
      auto value = lines_.Value((*words)[i + 1], -1000.0F, 1000.0F);
      if (!value) return std::unexpected(value.error());
      out[i] = *value;
    }
    return {};
  }

  vm::Result<void> Layer(TimeDelayNet& net) {
    auto words = lines_.Line("layer");
    if (!words) return std::unexpected(words.error());
    if (net.layers.size() == kMaxLayers) return Wrong("more than 8 layers found");
    if (words->size() < 5 || words->size() > 4 + kMaxOffsets) {
      return Wrong("layer INPUTS OUTPUTS relu|linear OFFSET... with 1 to 16 offsets expected");
    }
    const auto inputs = lines_.Value<std::size_t>((*words)[1], 1, kMaxVector);
    if (!inputs) return std::unexpected(inputs.error());
    const auto outputs = lines_.Value<std::size_t>((*words)[2], 1, kMaxVector);
    if (!outputs) return std::unexpected(outputs.error());
    if (!net.layers.empty() && net.outputs() != *inputs) {
      return Wrong(
          fmt::format("{} inputs found after a layer of {} outputs", *inputs, net.outputs()));
    }
    TimeDelayLayer layer;
    layer.inputs = *inputs;
    if ((*words)[3] != "relu" && (*words)[3] != "linear") {
      return Wrong("'" + std::string((*words)[3].substr(0, 40)) +
                   "' found, relu or linear expected");
    }
    layer.rectified = (*words)[3] == "relu";
    for (std::size_t i = 4; i < words->size(); ++i) {
      const auto offset = lines_.Value<int>((*words)[i], -kMaxOffset, kMaxOffset);
      if (!offset) return std::unexpected(offset.error());
      if (!layer.offsets.empty() && *offset <= layer.offsets.back()) {
        return Wrong("offsets that do not rise found");
      }
      layer.offsets.push_back(*offset);
    }
    const std::size_t columns = *inputs * layer.offsets.size();
    layer.weights.resize(static_cast<Eigen::Index>(*outputs), static_cast<Eigen::Index>(columns));
    layer.biases.resize(static_cast<Eigen::Index>(*outputs));
    for (Eigen::Index row = 0; row < layer.biases.size(); ++row) {
      if (auto read = Row(layer, row, columns); !read) return read;
    }
    net.layers.push_back(std::move(layer));
    return {};
  }

  vm::Result<void> Row(TimeDelayLayer& layer, Eigen::Index row, std::size_t columns) {
    const auto words = lines_.Line("row", 3);
    if (!words) return std::unexpected(words.error());
    const auto bias = lines_.Value((*words)[1], -1000.0F, 1000.0F);
    if (!bias) return std::unexpected(bias.error());
    const auto scale = lines_.Value((*words)[2], 0.0F, 1000.0F);
    if (!scale) return std::unexpected(scale.error());
    const auto weights = vm::DecodeBase64((*words)[3]);
    if (!weights) return Wrong("weights that are no base64 found");
    if (weights->size() != columns) {
      return Wrong(fmt::format("{} weights found, {} expected", weights->size(), columns));
    }
    layer.biases[row] = *bias;
    for (std::size_t i = 0; i < columns; ++i) {
      const int weight = static_cast<std::int8_t>((*weights)[i]);
      if (weight < -kMaxInteger) return Wrong("a weight of -128 found, -127 to 127 expected");
      layer.weights(row, static_cast<Eigen::Index>(i)) = *scale * static_cast<float>(weight);
    }
    return {};
  }

  WordLines lines_;
  const std::size_t bytes_;
};

}  // namespace

vm::Result<MouthNet> ParseMouthNet(const std::string& name, std::string_view text) {
  return Reader(name, text).Read();
}

std::string FormatMouthNet(const MouthNet& net) {
  std::array<float, kShapeNumbers> means{};
  std::ranges::transform(net.means, means.begin(), WithoutDust);
  std::string text = fmt::format("features {}\nsounds {}\nmeans {:.6g}\nscales {:.6g}\n",
                                 FeatureName(net.features), fmt::join(net.sounds, " "),
                                 fmt::join(means, " "), fmt::join(net.scales, " "));
  for (const TimeDelayLayer& layer : net.net.layers) {
    text += fmt::format("layer {} {} {} {}\n", layer.inputs, layer.outputs(),
                        layer.rectified ? "relu" : "linear", fmt::join(layer.offsets, " "));
    for (Eigen::Index row = 0; row < layer.weights.rows(); ++row) {
      const float most = layer.weights.row(row).cwiseAbs().maxCoeff();
      const std::string scale_text = fmt::format("{:.6g}", WithoutDust(most / kMaxInteger));
      float scale = 0;  // as it will be read
      std::from_chars(scale_text.data(), scale_text.data() + scale_text.size(), scale);
      std::string weights;
      for (const float weight : layer.weights.row(row)) {
        const int integer = scale > 0 ? static_cast<int>(std::lround(weight / scale)) : 0;
        weights += static_cast<char>(std::clamp(integer, -kMaxInteger, kMaxInteger));
      }
      text += fmt::format("row {:.6g} {} {}\n", WithoutDust(layer.biases[row]), scale_text,
                          vm::EncodeBase64(weights));
    }
  }
  return text;
}

}  // namespace vdm
