#pragma once

#include <string>
#include <string_view>

namespace ssm {

/// `reference` against `base` (RFC 3986, section 5.2), for the references a document makes to
/// files: without queries and fragments; "." and ".." are left to the file system. Without a base,
/// and where it is absolute, the reference comes back as it is; an empty one is the base.
std::string ResolveUri(std::string_view base, std::string_view reference);

/// The path that a URI of the scheme "file" names; all else comes back as it is.
std::string FilePathOf(std::string_view uri);

}  // namespace ssm
