#include "vdm/words/word_tree.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "vdm/words/word_likelihoods.h"
#include "vm_protocol/core/text_file.h"

namespace vdm {
namespace {

using Phone = ContextModel::Phone;
constexpr std::size_t kMostBytes = std::size_t{32} << 20, kMostPhones = 64, kMostNodes = 4'000'000;

/// The first word of a line, which it loses.
std::string_view NextWord(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace

/// A tree whose nodes point to each other, before they stand in order.
class WordTree::Builder {
 public:
  Builder(const std::string& path, const ContextModel& contexts)
      : path_(path), contexts_(contexts) {
    const auto& names = contexts.phones().phones();
    for (std::size_t i = 0; i < names.size(); ++i) phones_[names[i]] = static_cast<Phone>(i);
  }

  vm::Result<void> Add(std::string_view text,
                       const std::unordered_map<std::string, float>& likelihoods) {
    std::vector<Phone> said;
    for (std::size_t number = 1; !text.empty(); ++number) {
      std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(line.size() + 1, text.size()));
      const std::string_view word = NextWord(line);
      if (word.empty()) continue;
      said.clear();
      for (std::string_view name = NextWord(line); !name.empty(); name = NextWord(line)) {
        const auto phone = phones_.find(name);
        if (phone == phones_.end()) {
          return Wrong(number, "'" + std::string(name.substr(0, 40)) + "' found, a phone expected");
        }
        said.push_back(phone->second);
      }
      if (said.empty() || said.size() > kMostPhones) {
        return Wrong(number, "WORD and 1 to 64 phones expected");
      }
      const auto likely = likelihoods.find(std::string(word.substr(0, word.find('('))));
      if (likely == likelihoods.end()) continue;
      Add(said, likely->second);
      if (parts_.size() > kMostNodes) return Wrong(number, "more than 4 million phones found");
    }
    if (parts_.size() == 1) return Wrong(1, "no word found that is also in the language model");
    return {};
  }

  /// Breadth first, so that the children of a node stand together.
  void Store(WordTree& tree) {
    std::vector<std::size_t> order;
    const auto append = [&](const Part& parent) {
      order.insert(order.end(), parent.children.begin(), parent.children.end());
    };
    append(parts_.front());
    tree.roots_ = order.size();
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Part& part = parts_[order[i]];
      Node node = part.node;
      node.first_child = static_cast<std::uint32_t>(order.size());
      node.children = static_cast<std::uint32_t>(part.children.size());
      if (!node.begins && node.next != kNone) {
        node.states =
            contexts_.SequenceOf(node.phone, part.left, node.next, ContextModel::Place::kInside);
      } else if (!node.begins) {
        node.states = EndingOf(tree, node.phone, part.left, ContextModel::Place::kEnd);
      }
      tree.nodes_.push_back(node);
      append(part);
    }
    const auto count = static_cast<Phone>(phones_.size());
    for (std::size_t root = 0; root < tree.roots_; ++root) {
      const auto [phone, next] = std::pair(tree.nodes_[root].phone, tree.nodes_[root].next);
      for (Phone left = 0; left < count && next != kNone; ++left) {
        tree.beginnings_.push_back(
            contexts_.SequenceOf(phone, left, next, ContextModel::Place::kBegin));
      }
      tree.beginnings_.resize((root + 1) * count);
    }
    for (Phone phone = 0; phone < count; ++phone) {
      for (Phone left = 0; left < count; ++left) {
        tree.single_.push_back(EndingOf(tree, phone, left, ContextModel::Place::kSingle));
      }
    }
  }

 private:
  struct Part {
    Node node{};
    Phone left = kNone;
    std::vector<std::size_t> children{};
  };

  std::unexpected<vm::Error> Wrong(std::size_t line, const std::string& what) const {
    return vm::Fail(vm::Errc::kBadValue, path_ + ":" + std::to_string(line) + ": " + what);
  }

  void Add(const std::vector<Phone>& said, float likely) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < said.size(); ++i) {
      const Phone next = i + 1 < said.size() ? said[i + 1] : kNone;
      const auto& beside = parts_[at].children;
      const auto found = std::ranges::find_if(beside, [&](std::size_t child) {
        const Node& node = parts_[child].node;
        return node.phone == said[i] && node.next == next;
      });
      const std::size_t child = found != beside.end() ? *found : parts_.size();
      if (child == parts_.size()) {
        parts_[at].children.push_back(child);
        parts_.push_back({.node = {.phone = said[i], .next = next, .begins = i == 0},
                          .left = i > 0 ? said[i - 1] : kNone});
      }
      at = child;
      parts_[at].node.likely = std::max(parts_[at].node.likely, likely);
    }
    parts_[at].node.word = std::max(parts_[at].node.word, likely);
  }

  std::uint16_t EndingOf(WordTree& tree, Phone phone, Phone left, ContextModel::Place place) {
    const auto [found, added] = endings_.try_emplace({phone, left, place}, tree.endings_.size());
    if (added) {
      std::vector<ContextModel::Sequence> sequences;
      for (const auto& [name, right] : phones_) {
        if (!name.starts_with('+'))
          sequences.push_back(contexts_.SequenceOf(phone, left, right, place));
      }
      std::ranges::sort(sequences);
      const auto [first, last] = std::ranges::unique(sequences);
      sequences.erase(first, last);
      tree.endings_.push_back({std::move(sequences)});
    }
    return static_cast<std::uint16_t>(found->second);
  }

  const std::string& path_;
  const ContextModel& contexts_;
  std::map<std::string, Phone, std::less<>> phones_;
  std::vector<Part> parts_{1};
  std::map<std::tuple<Phone, Phone, ContextModel::Place>, std::size_t> endings_;
};

vm::Result<std::shared_ptr<const WordTree>> WordTree::Read(
    const std::string& dictionary, const std::string& likelihoods,
    std::shared_ptr<const ContextModel> contexts) {
  const auto likely = ReadWordLikelihoods(likelihoods);
  if (!likely) return std::unexpected(likely.error());
  const auto text = vm::ReadTextFile(dictionary, kMostBytes);
  if (!text) return std::unexpected(text.error());
  auto tree = std::make_shared<WordTree>();
  tree->contexts_ = std::move(contexts);
  Builder builder(dictionary, *tree->contexts_);
  if (auto added = builder.Add(*text, *likely); !added) return std::unexpected(added.error());
  builder.Store(*tree);
  return tree;
}

const WordTree::Ending& WordTree::SingleEnding(Phone phone, Phone left) const {
  return endings_[single_[phone * contexts_->phones().phones().size() + left]];
}

const vm::Result<std::shared_ptr<const WordTree>>& InstalledWordTree() {
  static const auto tree = []() -> vm::Result<std::shared_ptr<const WordTree>> {
    const auto& phones = InstalledPhoneModel();
    if (!phones) return std::unexpected(phones.error());
    auto contexts = ContextModel::Read(kPhoneModelFolder, *phones);
    if (!contexts) return std::unexpected(contexts.error());
    const std::string language = std::string(kPhoneModelFolder) + "/../";
    return WordTree::Read(language + "cmudict-en-us.dict", language + "en-us.lm.bin",
                          std::move(*contexts));
  }();
  return tree;
}

}  // namespace vdm
