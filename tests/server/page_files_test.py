"""The page's files over HTTP: compressed for those that take it, named by their content."""

import gzip
import tempfile
from pathlib import Path

from connecting_test import RunningServer
from foreign_client import Server, main

PAGE = b"the page, " * 200


class CompressedFiles(RunningServer):
    def setUp(self):
        page = tempfile.TemporaryDirectory()
        self.addCleanup(page.cleanup)
        Path(page.name, "index.html").write_bytes(PAGE)
        Path(page.name, "index.html.gz").write_bytes(gzip.compress(PAGE))
        Path(page.name, "index.html.br").write_bytes(b"shortest")  # the server does not look inside
        Path(page.name, "plain.txt").write_bytes(PAGE)
        Path(page.name, "alone.gz").write_bytes(b"a file by itself")
        self.server = Server("--paused", "--web", page.name)
        self.port = self.server.addresses["port"]

    def page(self, accepted=None, path="/", fields=""):
        accepting = f"Accept-Encoding: {accepted}\r\n" if accepted is not None else ""
        return self.raw(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n{accepting}{fields}\r\n")

    def test_a_client_gets_the_smallest_form_that_it_takes(self):
        for accepted, encoding in [
                (None, None), ("", None), ("identity", None), ("deflate", None), ("gzip", "gzip"), ("GZIP", "gzip"),
                ("gzip, deflate, br", "br"), ("br;q=0, gzip;q=0.5", "gzip"), ("gzip;q=0.000", None),
                ("br;q=1.0", "br"), (";;;,,=", None), ("brr, gzipp", None)]:
            with self.subTest(accepted=accepted):
                answer = self.page(accepted)
                self.assertEqual(answer.status, 200)
                self.assertEqual(answer.fields.get("content-encoding"), encoding)
                self.assertEqual(answer.fields["vary"], "Accept-Encoding")
                self.assertTrue(answer.fields["content-type"].startswith("text/html"))
                content = gzip.decompress(answer.body) if encoding == "gzip" else answer.body
                self.assertEqual(content, b"shortest" if encoding == "br" else PAGE)

    def test_each_form_has_a_name_of_its_own_and_is_not_sent_twice(self):
        names = {accepted: self.page(accepted).fields["etag"] for accepted in ("identity", "gzip", "br")}
        self.assertEqual(len(set(names.values())), 3)
        for accepted, name in names.items():
            answer = self.page(accepted, fields=f"If-None-Match: {name}\r\n")
            self.assertEqual((answer.status, answer.body), (304, b""))
        self.assertEqual(self.page("br", fields=f"If-None-Match: {names['gzip']}\r\n").status, 200)

    def test_a_file_without_compressed_forms_goes_as_it_is(self):
        answer = self.page("gzip, br", "/plain.txt")
        self.assertNotIn("content-encoding", answer.fields)
        self.assertEqual(answer.body, PAGE)
        self.assertEqual(self.page("gzip", "/alone.gz").body, b"a file by itself")
        self.assertEqual(self.page("gzip", "/index.html.gz").status, 404)


if __name__ == "__main__":
    main()
