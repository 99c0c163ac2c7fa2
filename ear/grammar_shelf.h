#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "vm_protocol/core/slot_machine.h"

namespace ear {

inline constexpr std::size_t kMaxGrammars = 256;

/// The grammars loaded, by name, and which of them are active, in order of preference.
/// Errors: kBadValue (no such grammar, a name that cannot be one), kLimit.
template <class G>
class GrammarShelf {
 public:
  vm::Result<std::string> Put(const std::string& name, vm::Result<G> grammar) {
    if (name == "NONE" || !vm::IsSlotName(name)) {
      return vm::Fail(vm::Errc::kBadValue, "'" + name + "' cannot be a grammar's name");
    }
    if (!grammar) return std::unexpected(grammar.error());
    if (!loaded_.contains(name) && loaded_.size() >= kMaxGrammars) {
      return vm::Fail(vm::Errc::kLimit, "more than " + std::to_string(kMaxGrammars) + " grammars");
    }
    loaded_.insert_or_assign(name, std::move(*grammar));
    return name;
  }

  /// True if it was active.
  vm::Result<bool> Drop(const std::string& name) {
    if (loaded_.erase(name) == 0) return std::unexpected(Missing(name));
    return std::erase(active_, name) > 0;
  }

  /// The names of a value "NONE | <word>...", each once.
  vm::Result<std::vector<std::string>> Chosen(const vm::SetValue& value) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string& name = value.word(i);
      if (name == "NONE" && value.size() == 1) break;
      if (!loaded_.contains(name)) return std::unexpected(Missing(name));
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
  }

  /// REQUIRES: all are loaded. Returns those active before.
  std::vector<std::string> Activate(std::vector<std::string> names) {
    return std::exchange(active_, std::move(names));
  }

  bool IsActive(const std::string& name) const {
    return std::find(active_.begin(), active_.end(), name) != active_.end();
  }
  const std::vector<std::string>& active() const { return active_; }
  const G& at(const std::string& name) const { return loaded_.at(name); }

  /// "NONE" if none is active.
  std::string ActiveNames() const {
    std::string names;
    for (const std::string& name : active_) names += (names.empty() ? "" : " ") + name;
    return names.empty() ? "NONE" : names;
  }
  std::string Names() const {
    std::string names;
    for (const auto& [name, grammar] : loaded_) names += (names.empty() ? "" : " ") + name;
    return names;
  }

 private:
  static vm::Error Missing(const std::string& name) {
    return {vm::Errc::kBadValue, "no grammar '" + name + "' is loaded", 0};
  }
  std::map<std::string, G, std::less<>> loaded_;
  std::vector<std::string> active_;
};

/// What the slots of grammars do.
struct GrammarSlots {
  std::string none_help{};  ///< what is heard with NONE
  std::function<vm::Result<std::string>(const vm::SetValue&)> activate{};
  std::function<vm::Result<std::string>(const std::string& name, const std::string& text)> load{};
  std::function<vm::Result<std::string>(const std::string& path)> read_file{};
  std::function<vm::Result<std::string>(const std::string& name)> drop{};
  std::function<std::string()> names{};
};
/// Declares Grammar, Grammar.load, .file, .drop and .set.
void DeclareGrammarSlots(vm::SlotMachine& slots, const GrammarSlots& grammars);

}  // namespace ear
