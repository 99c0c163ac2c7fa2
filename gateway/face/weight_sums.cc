#include "gateway/face/weight_sums.h"

#include <algorithm>

#include "vdm/net/word_lines.h"

namespace gateway {

vm::Result<WeightSums> WeightSums::Read(
    const std::string& table, std::string_view text,
    const std::function<std::optional<std::size_t>(std::string_view)>& number_of) {
  vdm::WordLines lines(table, text);
  WeightSums read;
  for (auto words = lines.Next(); !words.empty(); words = lines.Next()) {
    if (std::ranges::find(read.names, words[0]) != read.names.end()) {
      return lines.Wrong("'" + std::string(words[0]) + "' is here twice");
    }
    read.names.emplace_back(words[0]);
    Sum& sum = read.sums.emplace_back();
    for (const std::string_view word : std::span(words).subspan(1)) {
      const std::size_t colon = std::min(word.find(':'), word.size());
      const auto number = number_of(word.substr(0, colon));
      if (!number) return lines.Wrong("'" + std::string(word) + "' found, NUMBER:FACTOR expected");
      const auto factor = lines.Number(word.substr(std::min(colon + 1, word.size())));
      if (!factor) return std::unexpected(factor.error());
      sum.emplace_back(*number, *factor);
    }
  }
  return read;
}

std::vector<float> WeightSums::Of(std::span<const float> numbers) const {
  std::vector<float> weights;
  for (const Sum& sum : sums) {
    float weight = 0;
    for (const auto& [number, factor] : sum) weight += factor * numbers[number];
    weights.push_back(std::clamp(weight, 0.0F, 1.0F));
  }
  return weights;
}

}  // namespace gateway
