#include "chat/text/apologies.h"

#include "chat/text/table_lines.h"

namespace chat {

vm::Result<Apologies> Apologies::Parse(const std::string& file, std::string_view text) {
  Apologies apologies;
  for (const TableLine& line : TableLines(text)) {
    std::string_view rest = line.text;
    const auto word = [&rest] {
      const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
      const std::string found(rest.substr(0, end));
      rest = vm::Trimmed(rest.substr(end));
      return found;
    };
    const std::string language = word();
    const std::string trouble = word();
    if (rest.empty()) {
      return vm::Fail(vm::Errc::kSyntax,
                      Place(file, line.number) + "expected LANGUAGE TROUBLE TEXT");
    }
    apologies.texts_[{language, trouble}].texts.emplace_back(rest);
  }
  return apologies;
}

std::string Apologies::For(const std::string& language, const std::string& trouble) {
  auto found = texts_.find({language, trouble});
  if (found == texts_.end()) found = texts_.find({"en", trouble});
  if (found == texts_.end()) return "";
  Texts& texts = found->second;
  return texts.texts[texts.next++ % texts.texts.size()];
}

}  // namespace chat
