#include "vm_protocol/http/multipart.h"

#include <algorithm>

namespace vm {

void SetForm(const std::vector<FormPart>& parts, HttpRequest& request) {
  // What divides the parts must be in none of them.
  std::string boundary = "galatea-form";
  for (unsigned long number = 0; std::ranges::any_of(
           parts,
           [&](const FormPart& part) { return part.content.find(boundary) != std::string::npos; });
       ++number) {
    boundary = "galatea-form-" + std::to_string(number);
  }
  request.body.clear();
  for (const FormPart& part : parts) {
    request.body +=
        "--" + boundary + "\r\nContent-Disposition: form-data; name=\"" + part.name + "\"";
    if (!part.file_name.empty()) {
      request.body += "; filename=\"" + part.file_name + "\"\r\nContent-Type: " + part.content_type;
    }
    request.body += "\r\n\r\n" + part.content + "\r\n";
  }
  request.body += "--" + boundary + "--\r\n";
  request.headers.push_back("Content-Type: multipart/form-data; boundary=" + boundary);
}

}  // namespace vm
