// The loader: any bytes become a document or a refusal with a place.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "task_manager/document/vxml_document.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  auto document = vxml::LoadDocument(bytes, "fuzz:document");
  if (!document && document.error().text.find("fuzz:document") == std::string::npos) std::abort();
  return 0;
}
