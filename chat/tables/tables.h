#pragma once

#include <string_view>

/// The tables the program carries, as their files are.
namespace chat::tables {

std::string_view Abbreviations();
std::string_view Apologies();
std::string_view Prompt();
std::string_view RulesEnglish();
std::string_view RulesJapanese();
std::string_view Tags();
std::string_view Talk();

}  // namespace chat::tables
