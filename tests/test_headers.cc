// SPDX-License-Identifier: Apache-2.0
// Nothing but an owner for the precompiled headers of the tests.
