// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/sha256.h"

#include <array>

#include <openssl/evp.h>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

tl::unexpected<Status> CannotCompute() { return Error(StatusCode::kInternal, "OpenSSL cannot compute a SHA-256"); }

}  // namespace

void Sha256Digest::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256Digest::Sha256Digest() : context_(EVP_MD_CTX_new()) {
  if (context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) context_.reset();
}

Result<void> Sha256Digest::Add(std::string_view bytes) {
  if (context_ == nullptr) return CannotCompute();
  if (!bytes.empty() && EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) != 1) return CannotCompute();
  return {};
}

Result<std::string> Sha256Digest::Text() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (context_ == nullptr || EVP_DigestFinal_ex(context_.get(), digest.data(), &size) != 1) return CannotCompute();
  std::string text;
  for (unsigned int i = 0; i < size; ++i) text += {HexDigit(digest.at(i) >> 4), HexDigit(digest.at(i) & 15)};
  return text;
}

Result<std::string> Sha256(std::string_view bytes) {
  Sha256Digest digest;
  RETURN_IF_ERROR(digest.Add(bytes));
  return digest.Text();
}

}  // namespace pendulum
