// Bytes as text (RFC 4648, section 4), for what stands inside a page.
#pragma once

#include <string>
#include <string_view>

namespace waretwin {

// With padding, without line breaks.
std::string base64(std::string_view bytes);

}  // namespace waretwin
