#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ssm {

/// How a text is said that SSML's <say-as> gives a meaning; English in words, Japanese with kanji
/// and figures as its normaliser reads them (ssm/japanese/normalizer.h). `how`, `format` and
/// examples (W3C Note "SSML 1.0 say-as attribute values", 2005, and usage since):
///   characters, spell-out          "ab1"         A, B, 1
///   digits                         "203"         2 0 3
///   telephone                      "+81 3-12"    plus 8 1, 3, 1 2
///   cardinal, number               "1203"        one thousand two hundred and three
///   ordinal                        "21"          twenty first                 21番目
///   date    mdy dmy ymd md ...     "11/24/2026"  November twenty fourth, twenty twenty six
///                                                                             2026年11月24日
///   time    hms12 hms24            "2:05pm"      two oh five P M              午後2時5分
///   currency                       "$20.50"      twenty dollars and fifty cents   20.5ドル
/// None: the meaning is not known, or the text has none of that kind; it is read as it is written.
std::optional<std::string> SpokenForm(std::string_view how, std::string_view format,
                                      std::string_view text, std::string_view language);

/// What a text has to be for that meaning ("a whole number of at most 15 digits"); empty if the
/// meaning is not known.
std::string_view ExpectedOf(std::string_view how);

}  // namespace ssm
