#include "vdm/words/word_likelihoods.h"

#include <cmath>
#include <vector>

#include "vdm/features/model_file.h"

namespace vdm {
namespace {

constexpr std::string_view kHead = "Trie Language Model";
constexpr std::size_t kMostOrder = 5, kMostWords = 1'000'000;
// Probabilities are logarithms to this base.
const float kBase = static_cast<float>(std::log(1.0001));
// Values of the quantised numbers: two kinds for each order between the first and the last, one
// for the last.
constexpr std::size_t kQuantised = std::size_t{1} << 16;

}  // namespace

vm::Result<std::unordered_map<std::string, float>> ReadWordLikelihoods(const std::string& path) {
  auto file = ModelFile::Open(path);
  if (!file) return std::unexpected(file.error());
  if (file->Text(kHead.size()) != kHead) return file->Wrong("no language model as a trie found");
  const std::size_t order = file->Value<std::uint8_t>();
  if (order < 2 || order > kMostOrder) return file->Wrong("an order of 2 to 5 expected");
  const std::size_t words = file->Count();
  for (std::size_t i = 1; i < order; ++i) file->Count();
  if (words > kMostWords) return file->Wrong("more than a million words found");
  file->Count();  // the kind of quantising
  file->View((2 * (order - 2) + 1) * kQuantised * sizeof(float));
  std::vector<float> likelihoods;
  std::size_t next = 0;
  for (std::size_t i = 0; i <= words; ++i) {  // and one behind the last, of which `next` counts
    const float likely = file->Value<float>();
    file->Value<float>();
    const std::size_t pairs = file->Count();
    if (!file->ok() || pairs < next || (i < words && !(likely <= 0))) {
      return file->Wrong("word " + std::to_string(i) + " is damaged");
    }
    next = pairs;
    if (i < words) likelihoods.push_back(kBase * likely);
  }
  // The words end the file, behind their length.
  if (!file->SkipToTail()) return file->Wrong("no words found at its end");
  std::unordered_map<std::string, float> out;
  for (const float likely : likelihoods) out[file->Word()] = likely;
  if (!file->ok()) return file->Wrong("ends within its words");
  return out;
}

}  // namespace vdm
