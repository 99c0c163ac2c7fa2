// The text of a model, read and written.

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "vdm/net/word_lines.h"
#include "vdm/triphone/triphone_model.h"

namespace vdm {
namespace {

constexpr std::size_t kMostBytes = std::size_t{8} << 20;
constexpr std::size_t kMostSets = 256, kMostNodes = 4096;
constexpr std::size_t kNumbers = kWindows * kTrackNumbers;
constexpr double kLeastVariance = 1e-9, kMost = 1e6;
constexpr double kShortestStepMs = 1, kLongestStepMs = 100;
constexpr std::array<const char*, kStates> kStateNames = {"beginning", "middle", "end"};

template <typename Range>
int IndexIn(const Range& range, std::string_view name) {
  const auto found = std::ranges::find(range, name);
  return found == range.end() ? -1 : static_cast<int>(found - range.begin());
}

class ModelReader {
 public:
  ModelReader(const std::string& name, std::string_view text) : lines_(name, text) {}

  vm::Result<TriphoneModel> Read() {
    const auto step = lines_.Line("step", 1);
    if (!step) return std::unexpected(step.error());
    const auto ms = lines_.Value((*step)[1], kShortestStepMs, kLongestStepMs);
    if (!ms) return std::unexpected(ms.error());
    model_.step_ms = *ms;
    while (lines_.Key() == "set") {
      if (auto read = Set(); !read) return std::unexpected(read.error());
    }
    for (std::size_t state = 0; state < kStates; ++state) {
      const auto words = lines_.Line("state", 1);
      if (!words) return std::unexpected(words.error());
      if ((*words)[1] != kStateNames[state]) {
        return lines_.Wrong(fmt::format("state '{}' found, '{}' expected",
                                        (*words)[1].substr(0, 40), kStateNames[state]));
      }
      if (auto read = Tree(model_.trees[state]); !read) return std::unexpected(read.error());
    }
    if (lines_.More()) return lines_.Wrong("more found behind the three states");
    return std::move(model_);
  }

 private:
  vm::Result<void> Set() {
    const auto words = lines_.Line("set");
    if (!words) return std::unexpected(words.error());
    if (words->size() < 3) return lines_.Wrong("set NAME PHONEME... expected");
    const std::string name((*words)[1]);
    if (IndexIn(names_, name) >= 0) return lines_.Wrong("the set '" + name + "' is here twice");
    if (names_.size() == kMostSets) return lines_.Wrong("at most 256 sets expected");
    names_.push_back(name);
    model_.sets.push_back({name, {words->begin() + 2, words->end()}});
    return {};
  }

  /// The nodes stand each before its children, and what yes leads to before what no leads to.
  vm::Result<void> Tree(std::vector<TreeNode>& tree) {
    std::vector<std::pair<std::size_t, bool>>
        open;  // whose way of yes or no leads to the next node
    do {
      if (tree.size() == kMostNodes) return lines_.Wrong("at most 4096 nodes of a state expected");
      if (!open.empty()) {
        const auto [parent, yes] = open.back();
        open.pop_back();
        (yes ? tree[parent].yes : tree[parent].no) = tree.size();
      }
      const bool asks = lines_.Key() == "ask";
      auto node = asks ? Question() : Leaf();
      if (!node) return std::unexpected(node.error());
      if (asks) {
        open.emplace_back(tree.size(), false);
        open.emplace_back(tree.size(), true);
      }
      tree.push_back(std::move(*node));
    } while (!open.empty());
    return {};
  }

  vm::Result<TreeNode> Question() {
    const auto words = lines_.Line("ask", 2);
    if (!words) return std::unexpected(words.error());
    const int side = IndexIn(kSideNames, (*words)[1]);
    if (side < 0) {
      return lines_.Wrong(
          fmt::format("'{}' found, left, centre or right expected", (*words)[1].substr(0, 40)));
    }
    const int set = IndexIn(names_, (*words)[2]);
    if (set < 0) {
      return lines_.Wrong(fmt::format("no set '{}' found above", (*words)[2].substr(0, 40)));
    }
    return TreeNode{.side = static_cast<Side>(side), .set = set};
  }

  vm::Result<TreeNode> Leaf() {
    if (auto words = lines_.Line("leaf", 0); !words) return std::unexpected(words.error());
    TreeNode leaf;
    auto means = Numbers("means", -kMost);
    if (!means) return std::unexpected(means.error());
    auto variances = Numbers("variances", kLeastVariance);
    if (!variances) return std::unexpected(variances.error());
    leaf.expectation = {std::move(*means), std::move(*variances)};
    return leaf;
  }

  vm::Result<Eigen::VectorXd> Numbers(std::string_view key, double lowest) {
    const auto words = lines_.Line(key, kNumbers);
    if (!words) return std::unexpected(words.error());
    Eigen::VectorXd numbers(static_cast<Eigen::Index>(kNumbers));
    for (std::size_t i = 0; i < kNumbers; ++i) {
      const auto value = lines_.Value((*words)[i + 1], lowest, kMost);
      if (!value) return std::unexpected(value.error());
      numbers[static_cast<Eigen::Index>(i)] = *value;
    }
    return numbers;
  }

  WordLines lines_;
  std::vector<std::string> names_;
  TriphoneModel model_;
};

std::string Numbers(std::string_view key, const Eigen::VectorXd& numbers) {
  std::string text(key);
  for (const double number : numbers) text += fmt::format(" {:.4g}", number);
  return text + '\n';
}

void WriteTree(const TriphoneModel& model, const std::vector<TreeNode>& tree, std::string& text) {
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const TreeNode& node = tree[open.back()];
    open.pop_back();
    if (node.set < 0) {
      text += "leaf\n" + Numbers("means", node.expectation.means) +
              Numbers("variances", node.expectation.variances);
      continue;
    }
    text += fmt::format("ask {} {}\n", kSideNames[static_cast<std::size_t>(node.side)],
                        model.sets[static_cast<std::size_t>(node.set)].name);
    open.push_back(node.no);
    open.push_back(node.yes);
  }
}

}  // namespace

vm::Result<TriphoneModel> ParseTriphones(const std::string& name, std::string_view text) {
  if (text.size() > kMostBytes) {
    return vm::Fail(vm::Errc::kLimit, name + ": longer than 8 MiB");
  }
  return ModelReader(name, text).Read();
}

std::string FormatTriphones(const TriphoneModel& model) {
  std::string text = fmt::format("step {:g}\n", model.step_ms);
  for (const PhonemeSet& set : model.sets) {
    text += fmt::format("set {} {}\n", set.name, fmt::join(set.phonemes, " "));
  }
  for (std::size_t state = 0; state < kStates; ++state) {
    text += fmt::format("state {}\n", kStateNames[state]);
    WriteTree(model, model.trees[state], text);
  }
  return text;
}

}  // namespace vdm
