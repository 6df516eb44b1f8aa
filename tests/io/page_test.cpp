#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "display_scenes.h"
#include "dowel/kernel/error.h"
#include "glb_file.h"
#include "program.h"

using namespace dowel;
using namespace dowel::testing;

namespace {

std::size_t count(std::string_view text, std::string_view part) {
  std::size_t result = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) {
    ++result;
  }
  return result;
}

/// What stands between `before` and the next `after`.
std::string_view between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t start = text.find(before);
  require(start != text.npos, "the opening is missing");
  const std::size_t end = text.find(after, start + before.size());
  require(end != text.npos, "the end is missing");
  return text.substr(start + before.size(), end - start - before.size());
}

std::string_view scene_of_page(std::string_view page) {
  return between(page, "id=\"scene\">", "</script>");
}

std::string_view script_of_page(std::string_view page) {
  return between(page, "<script>", "</script>");
}

std::vector<std::byte> from_base64(std::string_view text) {
  static constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  require(text.size() % 4 == 0, "base64 comes in groups of four");
  std::vector<std::byte> bytes;
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t value = kAlphabet.find(c);
    require(value != kAlphabet.npos, "not a base64 character");
    bits = bits << 6U | static_cast<std::uint32_t>(value);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> static_cast<unsigned>(bit_count) & 255U));
  }
  return bytes;
}

/// FIPS 180-4, with its constants computed from their definition: fractional parts of the roots of
/// the first primes.
std::array<std::uint32_t, 8> sha256(std::string message) {
  std::vector<std::uint32_t> primes;
  for (std::uint32_t n = 2; primes.size() < 64; ++n) {
    bool is_prime = true;
    for (const std::uint32_t p : primes) is_prime = is_prime && n % p != 0;
    if (is_prime) primes.push_back(n);
  }
  const auto fraction = [](long double root) {
    return static_cast<std::uint32_t>((root - std::floor(root)) * 4294967296.0L);
  };
  std::array<std::uint32_t, 8> hash{};
  for (std::size_t i = 0; i < 8; ++i)
    hash[i] = fraction(std::sqrt(static_cast<long double>(primes[i])));
  const std::uint64_t bit_count = 8 * message.size();
  message += '\x80';
  while (message.size() % 64 != 56) message += '\0';
  for (unsigned i = 8; i-- > 0;) message += static_cast<char>(bit_count >> (8U * i) & 255U);
  for (std::size_t block = 0; block < message.size(); block += 64) {
    std::array<std::uint32_t, 64> w{};
    for (std::size_t i = 0; i < 64; ++i) {
      w[i / 4] = w[i / 4] << 8U | static_cast<unsigned char>(message[block + i]);
    }
    for (std::size_t i = 16; i < 64; ++i) {
      const auto a = w[i - 15];
      const auto b = w[i - 2];
      w[i] = w[i - 16] + w[i - 7] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3U) +
             (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10U);
    }
    auto v = hash;
    for (std::size_t i = 0; i < 64; ++i) {
      const auto k = fraction(std::cbrt(static_cast<long double>(primes[i])));
      const auto t1 = v[7] + (std::rotr(v[4], 6) ^ std::rotr(v[4], 11) ^ std::rotr(v[4], 25)) +
                      ((v[4] & v[5]) ^ (~v[4] & v[6])) + k + w[i];
      const auto t2 = (std::rotr(v[0], 2) ^ std::rotr(v[0], 13) ^ std::rotr(v[0], 22)) +
                      ((v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]));
      v = {t1 + t2, v[0], v[1], v[2], v[3] + t1, v[4], v[5], v[6]};
    }
    for (std::size_t i = 0; i < 8; ++i) hash[i] += v[i];
  }
  return hash;
}

/// Checks that elements nest, that attributes are quoted, and that text holds no loose bracket.
/// Content of script and style is skipped, as a browser does.
void require_well_formed(std::string_view html) {
  static const std::set<std::string_view> kVoid{"meta", "input", "link", "br", "!doctype"};
  std::vector<std::string_view> open;
  for (std::size_t at = 0; (at = html.find('<', at)) != html.npos;) {
    const std::size_t end = html.find('>', at);
    require(end != html.npos, "a tag does not end");
    const std::string_view tag = html.substr(at + 1, end - at - 1);
    require(tag.find('<') == tag.npos, "a bracket inside a tag");
    require(count(tag, "\"") % 2 == 0, "a quote does not end");
    at = end + 1;
    if (tag.starts_with('/')) {
      require(!open.empty() && open.back() == tag.substr(1), "elements do not nest");
      open.pop_back();
      continue;
    }
    const std::string_view name = tag.substr(0, tag.find_first_of(" \n"));
    if (kVoid.contains(name)) continue;
    open.push_back(name);
    if (name == "script" || name == "style") {
      at = html.find("</" + std::string(name), at);
      require(at != html.npos, "a script or style does not end");
    }
  }
  require(open.empty(), "an element is not closed");
}

}  // namespace

TEST_CASE("the page holds the scene as GLB") {
  const std::string page = to_page(small_fixture());
  const std::vector<std::byte> glb = from_base64(scene_of_page(page));
  CHECK((glb == to_glb(small_fixture())));
  CHECK(parse_glb(glb).document.at("nodes").size() == 6);
}

TEST_CASE("base64 of the scene ends right for every remainder of three") {
  std::set<std::size_t> remainders;
  for (const char* title : {"", "1234", "12345678"}) {
    DisplayScene scene;
    scene.title = title;
    const auto glb = to_glb(scene);
    remainders.insert(glb.size() % 3);
    CHECK((from_base64(scene_of_page(to_page(scene))) == glb));
  }
  CHECK(remainders.size() == 3);
}

TEST_CASE("the page is well-formed and names nothing to load") {
  const std::string page = to_page(small_fixture());
  REQUIRE_NOTHROW(require_well_formed(page));
  for (std::size_t at = page.find("://"); at != page.npos; at = page.find("://", at + 1)) {
    // Namespaces are names, not addresses.
    CHECK(page.substr(at, 14) == "://www.w3.org/");
  }
  const std::string_view script = script_of_page(page);
  std::string frame = page;
  frame.erase(page.find(script), script.size());
  for (const char* loads : {" src=", " href=", "@import", "url(", "<link", "<iframe", "<img"}) {
    CAPTURE(loads);
    CHECK(count(frame, loads) == 0);
  }
}

TEST_CASE("the policy of the page allows its one script and nothing from elsewhere") {
  const std::string page = to_page(small_fixture());
  const std::string_view policy = between(page, "Content-Security-Policy\" content=\"", "\"");
  CHECK(policy.starts_with("default-src 'none';"));
  const auto allowed = from_base64(between(policy, "script-src 'sha256-", "'"));
  REQUIRE(allowed.size() == 32);
  const auto hash = sha256(std::string(script_of_page(page)));
  for (std::size_t i = 0; i < 32; ++i) {
    CHECK(std::to_integer<std::uint32_t>(allowed[i]) == (hash[i / 4] >> (24 - 8 * (i % 4)) & 255U));
  }
}

TEST_CASE("markup in titles and names is text") {
  const std::string plain = to_page(small_fixture());
  DisplayScene scene = small_fixture();
  const std::string evil = "</title></script><script>alert('&\"1\"')</script><b>\xFF\x01";
  scene.title = evil;
  scene.meshes[0].name = evil;
  scene.instances[0].name = evil;
  scene.instances[0].note = evil;
  const std::string page = to_page(scene);
  REQUIRE_NOTHROW(require_well_formed(page));
  CHECK(count(page, "<script") == count(plain, "<script"));
  CHECK(count(page, "</script") == count(plain, "</script"));
  CHECK(between(page, "<title>", "</title>") ==
        "&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(&#39;&amp;&quot;1&quot;&#39;)"
        "&lt;/script&gt;&lt;b&gt;\xEF\xBF\xBD ");
  CHECK(parse_glb(from_base64(scene_of_page(page))).document["nodes"][0]["extras"]["note"] ==
        "</title></script><script>alert('&\"1\"')</script><b>\xEF\xBF\xBD\x01");
}

TEST_CASE("a title that looks like a place to fill in is a title") {
  DisplayScene scene = small_fixture();
  scene.title = "@SCENE@ and @TITLE@";
  const std::string page = to_page(scene);
  CHECK(between(page, "<title>", "</title>") == scene.title);
  CHECK((from_base64(scene_of_page(page)) == to_glb(scene)));
}

TEST_CASE("a page appears whole or not at all") {
  const TemporaryFolder folder;
  write_page(folder / "page.html", small_fixture());
  CHECK(read_text(folder / "page.html") == to_page(small_fixture()));
  try {
    write_page(folder / "none" / "page.html", small_fixture());
    FAIL("expected an error");
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::FileUnwritable);
    CHECK_THAT(error.what(), Catch::Contains("page.html"));
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}
