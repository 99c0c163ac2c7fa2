#include "fsm/motion/inputs/expression_store.h"

#include "fsm/motion/base/motion_errors.h"
#include "fsm/motion/inputs/motion_tables.h"

namespace fsm {
namespace {

constexpr int kMaxPatterns = 20;
constexpr std::size_t kMaxExpressions = 200;

}  // namespace

ExpressionStore::ExpressionStore(const MotionTables& tables)
    : tables_(tables), all_(tables.expressions) {}

vm::Result<void> ExpressionStore::Define(std::string_view name, int pattern,
                                         std::string_view look) {
  if (!IsPlainName(name) || name == "NEUTRAL") {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("'{}' cannot be the name of an expression; up to {} letters, digits "
                    "and _ expected, and not NEUTRAL",
                    name.substr(0, 60), kMaxNameBytes));
  }
  auto units = ParseLook(look, tables_.unit_names);
  if (!units) return std::unexpected(units.error());
  const auto found = all_.find(name);
  const std::size_t have = found == all_.end() ? 0 : found->second.patterns.size();
  if (pattern < 1 || static_cast<std::size_t>(pattern) > have + 1 || pattern > kMaxPatterns) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("{} has {} patterns; pattern 1 to {} expected",
                                                     name, have, have + 1));
  }
  if (have == 0 && all_.size() >= kMaxExpressions) {
    return vm::Fail(vm::Errc::kLimit, fmt::format("more than {} expressions", kMaxExpressions));
  }
  all_[std::string(name)].Redefine(static_cast<std::size_t>(pattern), *units);
  return {};
}

void ExpressionStore::Forget(std::string_view name) {
  if (const auto built_in = tables_.expressions.find(name); built_in != tables_.expressions.end()) {
    all_[built_in->first] = built_in->second;
  } else if (const auto own = all_.find(name); own != all_.end()) {
    all_.erase(own);
  }
}

}  // namespace fsm
