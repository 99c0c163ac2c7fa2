// The slots of @AM about its peers: what they may do and what they have done.

#include "agent_manager/session.h"

namespace am {

using vm::Result;
using vm::SetValue;

namespace {

std::string_view KindName(PeerKind kind) {
  return kind == PeerKind::kConsole ? "CONSOLE" : kind == PeerKind::kModule ? "MODULE" : "CLIENT";
}

}  // namespace

void Session::DeclareLimitSlots() {
  for (const LimitName& limit : LimitNames()) {
    slots_.Declare(
        {.name = std::string("Limit.") + limit.name,
         .grammar = "<int " + std::to_string(limit.least) + ".." + std::to_string(limit.most) + ">",
         .initial = std::to_string(Limits().*limit.member),
         .help = limit.help,
         .on_set = [this, member = limit.member](const SetValue& value) -> Result<std::string> {
           hub_.limits().*member = static_cast<std::uint64_t>(value.number(0));
           return value.word(0);
         },
         .on_inq = [this,
                    member = limit.member] { return std::to_string(hub_.limits().*member); }});
  }
  slots_.Declare({.name = "Refused",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = "0",
                  .help = "How many were turned away at a door so far, and who the last one was."});
  slots_.Declare({.name = "Traffic",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "Of each peer: NAME KIND and, since it came, in=MESSAGES/BYTES, "
                          "out=MESSAGES/BYTES, backlog=BYTES not yet read, pending=REQUESTS it has "
                          "not answered, slots=it has defined, refused=LINES that were none, "
                          "throttled= and held=TIMES it was read slower; HELD if it is now.",
                  .on_inq = [this] {
                    std::string text;
                    const auto number = [](auto n) { return std::to_string(n); };
                    for (const PeerStatus& peer : hub_.Status()) {
                      const Traffic& t = peer.traffic;
                      text += (text.empty() ? "" : ", ") + peer.name + " " +
                              std::string(KindName(peer.kind)) + " in=" + number(t.messages_in) +
                              "/" + number(t.bytes_in) + " out=" + number(t.messages_out) + "/" +
                              number(t.bytes_out) + " backlog=" + number(peer.backlog_bytes) +
                              " pending=" + number(peer.pending) +
                              " slots=" + number(peer.defined) + " refused=" + number(t.refused) +
                              " throttled=" + number(t.throttled) + " held=" + number(t.held) +
                              (peer.held ? " HELD" : "");
                    }
                    return text;
                  }});
}

}  // namespace am
