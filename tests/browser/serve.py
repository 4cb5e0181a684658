#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""serve.py PORT: serves the current folder to a page, and writes what it posts, until it posts "done" or "failed"."""

import http.server
import pathlib
import sys


class Handler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def do_POST(self):
        name, body = pathlib.Path(self.path).name, self.rfile.read(int(self.headers["Content-Length"]))
        is_end = name in ("done", "failed")
        if not is_end:  # before the answer, after which the page posts "done"
            pathlib.Path(name).write_bytes(body)
        self.send_response(204)
        self.end_headers()
        if is_end:
            self.server.failed = name == "failed"
            print(body.decode(), end="")
            self.server.shutdown()


server = http.server.ThreadingHTTPServer(("127.0.0.1", int(sys.argv[1])), Handler)
server.serve_forever()
sys.exit(server.failed)
