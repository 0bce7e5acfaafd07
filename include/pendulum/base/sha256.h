// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"

struct evp_md_ctx_st;  // OpenSSL's EVP_MD_CTX

namespace pendulum {

/// SHA-256 (FIPS 180-4) of bytes that arrive in pieces. kInternal: OpenSSL cannot compute it.
class Sha256Digest {
 public:
  Sha256Digest();

  Result<void> Add(std::string_view bytes);

  /// The digest of all bytes added: 64 lower-case hexadecimal digits. Finishes the digest, so it must be the last call.
  Result<std::string> Text();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };

  std::unique_ptr<evp_md_ctx_st, Free> context_;  // Null if OpenSSL cannot start a digest.
};

/// SHA-256 of bytes in memory: 64 lower-case hexadecimal digits. kInternal: OpenSSL cannot compute it.
Result<std::string> Sha256(std::string_view bytes);

}  // namespace pendulum
