#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"
#include "vm_protocol/xml/node.h"

namespace vm::xml {

/// What a document may cost at most. Over a limit the document is refused as a whole.
struct Limits {
  std::size_t document_bytes = std::size_t{8} << 20;
  std::size_t text_bytes = std::size_t{1} << 20;  ///< one run of text or one attribute value
  std::size_t depth = 256;
  std::size_t nodes = 500'000;  ///< elements, attributes, runs of text, ...
  double entity_growth = 20.0;  ///< expanded bytes over bytes read, beyond the first 64 KiB
};

struct XmlDocument {
  std::unique_ptr<Node> root;
  std::vector<std::unique_ptr<Node>> prolog;  ///< comments and instructions before the root
  std::vector<std::unique_ptr<Node>> epilog;  ///< and behind it
  std::string encoding;                       ///< as declared, lower case; "utf-8" otherwise
};

/// Reads an XML document (expat; namespaces resolved, external entities and DTDs never fetched).
/// The encodings utf-8, utf-16, iso-8859-1 and us-ascii are expat's, all others those of
/// vm::DecodeCharset (euc-jp, shift_jis, ...); `charset` from outside, if not empty, wins over the
/// declaration. Errors (kSyntax, kTooLong, kLimit, kBadUtf8) read "NAME:LINE:COLUMN: what is
/// wrong". Thread: none of its own; no shared state.
vm::Result<XmlDocument> Parse(std::string_view bytes, const std::string& name,
                              const std::string& charset = "", const Limits& limits = {});

}  // namespace vm::xml
