#include "vm_protocol/http/multipart.h"

#include <algorithm>

namespace vm {
namespace {

std::string Quoted(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) {
    quoted += c == '"' ? "%22" : c == '\r' ? "%0D" : c == '\n' ? "%0A" : std::string(1, c);
  }
  return quoted + "\"";
}

}  // namespace

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
        "--" + boundary + "\r\nContent-Disposition: form-data; name=" + Quoted(part.name);
    if (!part.file_name.empty()) request.body += "; filename=" + Quoted(part.file_name);
    if (!part.content_type.empty()) request.body += "\r\nContent-Type: " + part.content_type;
    request.body += "\r\n\r\n" + part.content + "\r\n";
  }
  request.body += "--" + boundary + "--\r\n";
  request.headers.push_back("Content-Type: multipart/form-data; boundary=" + boundary);
}

}  // namespace vm
