#pragma once

#include <string_view>

#include "ssm/voice/span_builder.h"

namespace ssm {

/// Puts the text between a document's elements together (SSML 1.1, sections 1.2 and 3.1.8.2: tokens
/// do not span markup but inside of <token> and <w>). Where an element begins or ends between two
/// words (PartsWords), a blank goes between them, spoken and written; so does one between two
/// sentences, which are never analysed as one text. Runs of blanks become one; those at the
/// beginning and at the end of a sentence are left out.
class TextFlow {
 public:
  /// `builder` gets the text and outlives this.
  explicit TextFlow(SpanBuilder& builder) : builder_(builder) {}

  /// A run of blanks and line ends.
  void Blank();
  /// Text without blanks at its ends. Where it is written in one way and spoken in another, either
  /// form may ask for a blank before it.
  void Say(std::string_view written, std::string_view spoken);
  void Say(std::string_view text) { Say(text, text); }
  /// An element begins or ends here.
  void Edge() { edge_ = edge_ || tokens_ == 0; }
  /// A sentence or paragraph begins or ends here.
  void SentenceEdge() { sentence_ = true; }
  /// Between these two every element is inside one word. They may be nested.
  void OpenToken();
  void CloseToken();

 private:
  SpanBuilder& builder_;
  char32_t last_ = 0;      ///< the last sign that was spoken
  bool blank_ = true;      ///< a blank was the last, or there was nothing yet
  bool edge_ = false;      ///< an element began or ended since
  bool sentence_ = false;  ///< a sentence did
  unsigned tokens_ = 0;
};

}  // namespace ssm
