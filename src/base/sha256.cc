// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/sha256.h"

#include <array>

#include <openssl/evp.h>

#include "pendulum/base/format.h"

namespace pendulum {

Result<std::string> Sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    return Error(StatusCode::kInternal, "OpenSSL cannot compute a SHA-256");
  }
  std::string text;
  for (unsigned int i = 0; i < size; ++i) text += {HexDigit(digest.at(i) >> 4), HexDigit(digest.at(i) & 15)};
  return text;
}

}  // namespace pendulum
