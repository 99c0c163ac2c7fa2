#include "chat/tables/tables.h"

#include "embedded/chat_abbreviations.h"
#include "embedded/chat_apologies.h"
#include "embedded/chat_prompt.h"
#include "embedded/chat_rules_en.h"
#include "embedded/chat_rules_ja.h"
#include "embedded/chat_tags.h"
#include "embedded/chat_talk.h"

namespace chat::tables {

std::string_view Abbreviations() { return embedded::chat_abbreviations(); }
std::string_view Apologies() { return embedded::chat_apologies(); }
std::string_view Prompt() { return embedded::chat_prompt(); }
std::string_view RulesEnglish() { return embedded::chat_rules_en(); }
std::string_view RulesJapanese() { return embedded::chat_rules_ja(); }
std::string_view Tags() { return embedded::chat_tags(); }
std::string_view Talk() { return embedded::chat_talk(); }

}  // namespace chat::tables
