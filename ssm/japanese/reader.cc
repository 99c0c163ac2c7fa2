#include "ssm/japanese/reader.h"

#include <mecab.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "embedded/ja_counters.h"
#include "ssm/japanese/normalizer.h"
#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

/// The field of a MeCab feature line; empty if it is "*" or not there.
std::string Field(std::string_view feature, std::size_t wanted) {
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t comma = feature.find(',');
    if (comma == std::string_view::npos) return {};
    feature.remove_prefix(comma + 1);
  }
  const std::string_view field = feature.substr(0, feature.find(','));
  return field == "*" ? std::string() : std::string(field);
}

/// True for a text of kana and the long mark only.
bool IsKana(std::string_view text) {
  const std::u32string signs = vm::SignsOf(text);
  return !signs.empty() &&
         std::ranges::all_of(signs, [](char32_t c) { return c >= 0x3040 && c <= 0x30FF; });
}

std::string PauseOf(std::string_view sign) {
  for (const std::string_view stop : {"。", "．", "！", "？", ".", "!", "?", "…"}) {
    if (sign.starts_with(stop)) return "。";
  }
  for (const std::string_view comma :
       {"、", "，", ",", ";", ":", "；", "：", "（", "）", "(", ")"}) {
    if (sign.starts_with(comma)) return "、";
  }
  return {};
}

void Drop(std::string& text, std::string_view part) {
  for (std::size_t at; (at = text.find(part)) != std::string::npos;) text.erase(at, part.size());
}

}  // namespace

struct JapaneseReader::Parts {
  std::unique_ptr<mecab_model_t, void (*)(mecab_model_t*)> model{nullptr, mecab_model_destroy};
  std::unique_ptr<mecab_t, void (*)(mecab_t*)> tagger{nullptr, mecab_destroy};
  Counters counters;
};

std::vector<std::string> KnownDictionaries() {
  return {"/var/lib/mecab/dic/naist-jdic", "/var/lib/mecab/dic/ipadic-utf8",
          "/usr/share/mecab/dic/ipadic", "/var/lib/mecab/dic/debian"};
}

JapaneseReader::JapaneseReader(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
JapaneseReader::~JapaneseReader() = default;

vm::Result<std::unique_ptr<JapaneseReader>> JapaneseReader::Open(const std::string& dictionary) {
  std::string folder = dictionary;
  for (const std::string& known : KnownDictionaries()) {
    if (folder.empty() && std::filesystem::exists(known + "/sys.dic")) folder = known;
  }
  if (folder.empty()) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "there is no Japanese dictionary (Debian: mecab-naist-jdic)");
  }
  auto counters = Counters::Parse(embedded::ja_counters(), "ja_counters.txt");
  if (!counters) return std::unexpected(counters.error());
  auto parts = std::make_unique<Parts>();
  parts->counters = std::move(*counters);
  const std::string arguments = "-r /dev/null -d " + folder;
  parts->model.reset(mecab_model_new2(arguments.c_str()));
  const mecab_dictionary_info_t* info =
      parts->model ? mecab_model_dictionary_info(parts->model.get()) : nullptr;
  if (info == nullptr) {
    return vm::Fail(vm::Errc::kUnavailable, "'" + folder + "' is no MeCab dictionary");
  }
  const std::string charset = info->charset;
  if (charset != "UTF-8" && charset != "utf-8" && charset != "utf8" && charset != "UTF8") {
    return vm::Fail(vm::Errc::kUnavailable,
                    "dictionary '" + folder + "' is in " + charset + ", expected UTF-8");
  }
  parts->tagger.reset(mecab_model_new_tagger(parts->model.get()));
  return std::unique_ptr<JapaneseReader>(new JapaneseReader(std::move(parts)));
}

std::vector<JapaneseWord> JapaneseReader::Analyse(const std::string& text, std::string& unread) {
  std::vector<JapaneseWord> words;
  const mecab_node_t* node = mecab_sparse_tonode2(parts_->tagger.get(), text.c_str(), text.size());
  for (; node != nullptr; node = node->next) {
    if (node->stat == MECAB_BOS_NODE || node->stat == MECAB_EOS_NODE) continue;
    JapaneseWord word{std::string(node->surface, node->length), {}};
    std::string kana = Field(node->feature, 8);
    if (kana.empty()) kana = Field(node->feature, 7);
    if (kana.empty() && IsKana(word.text)) kana = word.text;
    Drop(kana, "’");
    if (const std::string pause = PauseOf(word.text); !pause.empty()) {
      word.kana = pause;
    } else if (IsKana(kana)) {
      word.kana = kana;
    } else {
      const bool word_like = static_cast<unsigned char>(word.text[0]) >= 0xE3 &&
                             !std::string_view(node->feature).starts_with("記号");
      if (word_like && unread.size() < 30) unread += word.text;
      continue;
    }
    words.push_back(std::move(word));
  }
  return words;
}

std::vector<JapaneseWord> JapaneseReader::Read(std::string_view text, std::string& unread) {
  std::vector<JapaneseWord> words;
  for (JapanesePart& part : NormalizeJapanese(text, parts_->counters)) {
    if (!part.reading.empty()) {
      words.push_back({std::move(part.text), std::move(part.reading)});
      continue;
    }
    for (JapaneseWord& word : Analyse(part.text, unread)) words.push_back(std::move(word));
  }
  return words;
}

}  // namespace ssm
