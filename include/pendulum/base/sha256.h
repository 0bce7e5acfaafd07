// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"

struct evp_md_ctx_st;  // OpenSSL's EVP_MD_CTX

namespace pendulum {

/// SHA-256 (FIPS 180-4) of bytes that come piece by piece. kInternal: OpenSSL cannot compute it.
class Sha256Digest {
 public:
  Sha256Digest();

  Result<void> Add(std::string_view bytes);

  /// Of all bytes added, 64 lower-case hexadecimal digits. It ends the digest: called once, and last.
  Result<std::string> Text();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };

  std::unique_ptr<evp_md_ctx_st, Free> context_;  // Null where OpenSSL cannot begin.
};

/// That of bytes in memory.
Result<std::string> Sha256(std::string_view bytes);

}  // namespace pendulum
