# Run by galatea_embed with -P: writes HEADER and SOURCE so that embedded::NAME() gives INPUT's bytes.
file(READ ${INPUT} bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR size "${digits} / 2")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)"
       "\\1\n" bytes "${bytes}")
file(WRITE ${HEADER} "#pragma once

#include <string_view>

namespace embedded {
std::string_view ${NAME}();
}
")
# The closing zero keeps the array legal for an empty file; it is not part of the view.
file(WRITE ${SOURCE} "#include \"embedded/${NAME}.h\"

namespace embedded {
std::string_view ${NAME}() {
  static const unsigned char bytes[] = {
${bytes}0x00};
  return {reinterpret_cast<const char*>(bytes), ${size}};
}
}
")
