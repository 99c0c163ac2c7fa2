#pragma once

#include <string>

namespace am {

/// The token of the page at `port`: kept in `$XDG_STATE_HOME/galatea/page_token_PORT` (else below
/// ~/.local/state), which only this user can read, so that a page that is open still has the right
/// cookie when the hub has been started anew. A file that is missing, too short or open to others
/// is replaced by one with a new token. Where nothing can be written, each call returns a new one.
std::string KeptToken(unsigned short port);

}  // namespace am
