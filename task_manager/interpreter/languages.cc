#include "task_manager/interpreter/languages.h"

#include <algorithm>

#include "vm_protocol/core/lower_case.h"

namespace vxml {
namespace {

// ISO 639-1, two letters each.
constexpr std::string_view kCodes =
    "aaabaeafakamanarasavayazbabebgbibmbnbobrbscacechcocrcscucvcydadedvdzeeeleneoeseteufafffifjfo"
    "frfygagdglgngugvhahehihohrhthuhyhziaidieigiiikioisitiujajvkakgkikjkkklkmknkokrkskukvkwkylalb"
    "lglilnloltlulvmgmhmimkmlmnmrmsmtmynanbndnengnlnnnonrnvnyocojomorospapiplpsptqurmrnrorurwsasc"
    "sdsesgsiskslsmsnsosqsrssstsusvswtatetgthtitktltntotrtstttwtyugukuruzvevivowawoxhyiyozazhzu";

/// The first part of a tag in lower case.
std::string Primary(std::string_view tag) {
  return vm::LowerCase(tag.substr(0, tag.find_first_of("-_")));
}

}  // namespace

bool IsSupported(std::string_view tag, const std::vector<std::string>& languages) {
  const std::string primary = Primary(tag);
  if (!languages.empty()) {
    return std::any_of(languages.begin(), languages.end(),
                       [&](const std::string& known) { return Primary(known) == primary; });
  }
  for (std::size_t at = 0; at + 1 < kCodes.size(); at += 2) {
    if (kCodes.substr(at, 2) == primary) return true;
  }
  return false;
}

}  // namespace vxml
