#include "task_manager/script/regexps.h"

#define PCRE2_CODE_UNIT_WIDTH 32
#include <pcre2.h>

#include <cstdlib>

namespace vxml::script {

/// The library's memory, counted: patterns can grow a lot when they are compiled.
struct Regexps::Limits {
  std::size_t used = 0;  // first: the contexts are counted already
  pcre2_general_context* general;
  pcre2_compile_context* compiling;
  pcre2_match_context* matching;

  Limits()
      : general(pcre2_general_context_create(&Allocate, &Release, this)),
        compiling(pcre2_compile_context_create(general)),
        matching(pcre2_match_context_create(general)) {
    pcre2_set_match_limit(matching, kMaxBacktracks);
    pcre2_set_heap_limit(matching, kMaxKilobytes);
  }
  Limits(const Limits&) = delete;
  Limits& operator=(const Limits&) = delete;
  ~Limits() {
    pcre2_match_context_free(matching);
    pcre2_compile_context_free(compiling);
    pcre2_general_context_free(general);
  }

 private:
  struct Header {
    std::size_t size;
    std::size_t pad;  // keeps the block behind it aligned
  };
  static void* Allocate(std::size_t size, void* self) {
    auto& limits = *static_cast<Limits*>(self);
    if (size > kMaxMemoryBytes || limits.used + size > kMaxMemoryBytes) return nullptr;
    auto* const header = static_cast<Header*>(std::malloc(sizeof(Header) + size));
    if (!header) return nullptr;
    header->size = size;
    limits.used += size;
    return header + 1;
  }
  static void Release(void* block, void* self) {
    if (!block) return;
    auto* const header = static_cast<Header*>(block) - 1;
    static_cast<Limits*>(self)->used -= header->size;
    std::free(header);
  }
};

struct Regexps::Compiled {
  pcre2_code* code;
  pcre2_match_data* data;
  Compiled(pcre2_code* given, pcre2_general_context* general)
      : code(given), data(pcre2_match_data_create_from_pattern(given, general)) {}
  Compiled(const Compiled&) = delete;
  Compiled& operator=(const Compiled&) = delete;
  ~Compiled() {
    pcre2_match_data_free(data);
    pcre2_code_free(code);
  }
};

Regexps::Regexps() : limits_(std::make_unique<Limits>()) {}
Regexps::~Regexps() = default;

const Regexps::Compiled* Regexps::Compile(std::string_view source, std::string_view flags) {
  if (source.size() > kMaxPatternBytes) return nullptr;
  std::pair<std::string, std::string> key{source, flags};
  if (const auto found = kept_.find(key); found != kept_.end()) return found->second.get();
  if (kept_.size() >= kMaxKept || limits_->used > kMaxMemoryBytes / 2) kept_.clear();
  const std::u32string pattern =
      TranslatePattern(Characters(source), flags.find('m') != std::string_view::npos);
  std::uint32_t options = PCRE2_NEVER_UTF | PCRE2_MATCH_UNSET_BACKREF;
  // Letters beyond ASCII have case as well; sets are written out, so they stay those of ECMA-262.
  if (flags.find('i') != std::string_view::npos) options |= PCRE2_CASELESS | PCRE2_UCP;
  int error = 0;
  PCRE2_SIZE place = 0;
  pcre2_code* code = pcre2_compile(reinterpret_cast<PCRE2_SPTR>(pattern.data()), pattern.size(),
                                   options, &error, &place, limits_->compiling);
  if (!code) return nullptr;
  auto compiled = std::make_unique<Compiled>(code, limits_->general);
  if (!compiled->data) return nullptr;
  return kept_.emplace(std::move(key), std::move(compiled)).first->second.get();
}

Regexps::Outcome Regexps::Match(std::string_view source, std::string_view flags,
                                std::u32string_view text, std::size_t from, Spans& spans) {
  const Compiled* compiled = Compile(source, flags);
  if (!compiled) return Outcome::kRefused;
  const int found = pcre2_match(compiled->code, reinterpret_cast<PCRE2_SPTR>(text.data()),
                                text.size(), from, 0, compiled->data, limits_->matching);
  if (found == PCRE2_ERROR_NOMATCH) return Outcome::kNoMatch;
  if (found < 0) return Outcome::kOverLimit;
  const PCRE2_SIZE* places = pcre2_get_ovector_pointer(compiled->data);
  const std::size_t count = 2 * std::size_t{pcre2_get_ovector_count(compiled->data)};
  spans.clear();
  for (std::size_t i = 0; i < count; ++i) {
    spans.push_back(places[i] == PCRE2_UNSET ? -1 : static_cast<long>(places[i]));
  }
  return Outcome::kMatch;
}

}  // namespace vxml::script
