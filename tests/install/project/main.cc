// A program outside the toolkit that uses its client library.
#include <cstdio>
#include <string>

#include "vm_protocol/core/client.h"

int main() {
  std::string said, answer;
  vm::Client client([&](std::string_view line) { said = line; });
  const std::string tag = client.Request(vm::To("SSM", vm::Inq("Speaker")),
                                         [&](vm::Result<std::string> value) { answer = *value; });
  client.HandleLine("From @SSM rep#" + tag + " Speaker = slt");
  std::printf("%s -> %s\n", said.c_str(), answer.c_str());
  return answer == "slt" ? 0 : 1;
}
