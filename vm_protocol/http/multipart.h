#pragma once

#include <string>
#include <vector>

#include "vm_protocol/http/http.h"

namespace vm {

/// A part of a form (RFC 7578). In names and file names quotes and line ends are sent as browsers
/// send them: %22, %0D, %0A.
struct FormPart {
  std::string name{};
  std::string content{};
  std::string file_name{};     ///< empty: a plain value
  std::string content_type{};  ///< empty: none is said
};
/// Makes the parts the request's body, as multipart/form-data, and says so in its headers.
void SetForm(const std::vector<FormPart>& parts, HttpRequest& request);

}  // namespace vm
