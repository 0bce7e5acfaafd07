// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/sha256.h"

#include <string>

#include <gtest/gtest.h>

namespace pendulum::sha256_test {
namespace {

// The examples of FIPS 180-4 (NIST, "Secure Hash Standard", examples with intermediate values), and the empty message.
TEST(Sha256, MatchesTheDigestsOfTheStandard) {
  EXPECT_EQ(Sha256("abc").value(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq").value(),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256("").value(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256(std::string(1000000, 'a')).value(),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// The digest does not depend on how the bytes are split.
TEST(Sha256Digest, CoversAllAddedBytes) {
  Sha256Digest digest;
  for (const char* piece : {"a", "", "bc"}) ASSERT_TRUE(digest.Add(piece));
  EXPECT_EQ(digest.Text().value(), Sha256("abc").value());
}

}  // namespace
}  // namespace pendulum::sha256_test
