#!/usr/bin/env python3
"""Speaks MCP as a client does: mcp_client.py REVISION COMMAND...   starts the server COMMAND and holds a conversation with it;
mcp_client.py REVISION http://HOST:PORT/mcp?token=TOKEN   holds it over HTTP.

Prints what it finds wrong and ends with 1, or `ok`.
"""
import json
import subprocess
import sys
import urllib.error
import urllib.parse
import urllib.request


class Server:
    def __init__(self, command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)
        self.last = 0

    def say(self, **message):
        print(json.dumps({"jsonrpc": "2.0", **message}), file=self.process.stdin, flush=True)

    def ask(self, method, **params):
        self.last += 1
        self.say(id=self.last, method=method, params=params)
        line = self.process.stdout.readline()
        return right_answer(line, self.last, method)

    def end(self):
        self.process.stdin.close()
        expect(self.process.stdout.read() == "", "nothing more is said")
        expect(self.process.wait(20) == 0, f"exit status {self.process.returncode}")


class HttpServer:
    """The streamable HTTP transport; the token goes into a header."""

    def __init__(self, url, revision):
        parts = urllib.parse.urlsplit(url)
        self.url = f"{parts.scheme}://{parts.netloc}{parts.path}"
        self.headers = {"Authorization": "Bearer " + urllib.parse.parse_qs(parts.query)["token"][0],
                        "Content-Type": "application/json", "Accept": "application/json, text/event-stream"}
        self.revision, self.last = revision, 0

    def send(self, method, body, **headers):
        """(status, headers, body)"""
        request = urllib.request.Request(self.url, body, {**self.headers, **headers}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, answer.headers, answer.read().decode()
        except urllib.error.HTTPError as error:
            return error.code, error.headers, error.read().decode()

    def say(self, **message):
        status, _, body = self.send("POST", json.dumps({"jsonrpc": "2.0", **message}).encode())
        expect(status == 202 and body == "", (status, body))

    def ask(self, method, **params):
        self.last += 1
        asked = {"jsonrpc": "2.0", "id": self.last, "method": method, "params": params}
        status, headers, body = self.send("POST", json.dumps(asked).encode())
        expect(status == 200 and headers["Content-Type"] == "application/json", (status, body))
        if method == "initialize":
            self.headers["Mcp-Session-Id"] = headers["Mcp-Session-Id"]
            self.headers["MCP-Protocol-Version"] = self.revision
        return right_answer(body, self.last, method)

    def end(self):
        ping = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "ping"}).encode()
        status, headers, _ = self.send("GET", None)
        expect(status == 405 and headers["Allow"] == "POST, DELETE", "GET opens no stream")
        expect(self.send("POST", ping, Origin="https://evil.example")[0] == 403, "another site's page")
        expect(self.send("POST", ping, Host="evil.example")[0] == 421, "another name of ours")
        expect(self.send("POST", ping, Authorization="Bearer wrong")[0] == 401, "without the token")
        expect(self.send("POST", ping, **{"MCP-Protocol-Version": "1999-01-01"})[0] == 400, "another revision")
        expect(self.send("POST", ping, **{"Content-Type": "text/plain"})[0] == 415, "another type")
        expect(self.send("POST", ping, Accept="text/html")[0] == 406, "no JSON wanted")
        expect(self.send("POST", ping, **{"Mcp-Session-Id": "guessed"})[0] == 404, "no such session")
        without = {name: value for name, value in self.headers.items() if name != "Mcp-Session-Id"}
        request = urllib.request.Request(self.url, ping, without, method="POST")
        try:
            urllib.request.urlopen(request, timeout=60)
            expect(False, "a request without a session")
        except urllib.error.HTTPError as error:
            expect(error.code == 400, error.code)
        status, _, body = self.send("POST", b"{nonsense")
        expect(status == 200 and json.loads(body)["error"]["code"] == -32700, body)
        expect(self.send("DELETE", None)[0] == 204, "the session ends")
        expect(self.send("POST", ping)[0] == 404, "it has ended")


def right_answer(text, number, method):
    answer = json.loads(text)
    expect(answer["jsonrpc"] == "2.0" and answer["id"] == number, f"{method}: {text}")
    return answer


def call(server, name, **arguments):
    return server.ask("tools/call", name=name, arguments=arguments)["result"]


def expect(right, what):
    if not right:
        sys.exit(f"mcp_client: wrong: {what}")


def main():
    revision, *command = sys.argv[1:]
    server = HttpServer(command[0], revision) if command[0].startswith("http://") else Server(command)
    begun = server.ask("initialize", protocolVersion=revision, capabilities={}, clientInfo={"name": "test", "version": "1"})
    expect(begun["result"]["protocolVersion"] == revision, begun)
    server.say(method="notifications/initialized")
    tools = {tool["name"]: tool for tool in server.ask("tools/list")["result"]["tools"]}
    expect(set(tools) == {"SSM_Rate", "SSM_Text", "SSM_Text_lead", "SSM_Text_next", "SSM_Text_text", "SSM_Text_pho", "SSM_Text_dur"}, sorted(tools))
    for tool in tools.values():
        expect(tool["description"] and tool["inputSchema"]["type"] == "object", tool)
    expect(tools["SSM_Rate"]["inputSchema"]["properties"]["value"] == {"type": "number", "minimum": 0.25, "maximum": 4.0},
           tools["SSM_Rate"])
    expect(call(server, "SSM_Rate", value=2)["content"][0]["text"] == "2", "set Rate")
    expect(call(server, "SSM_Rate")["content"][0]["text"] == "2", "inq Rate")
    wrong = call(server, "SSM_Rate", value=9)
    expect(wrong["isError"] and "BAD_VALUE" in wrong["content"][0]["text"], wrong)
    spoken = call(server, "SSM_Text", value="Good morning.")
    expect(not spoken["isError"], spoken)
    expect("[" in call(server, "SSM_Text_pho")["content"][0]["text"], "inq Text.pho")
    expect("error" in server.ask("tools/call", name="SSM_SaveWAV", arguments={"value": "x"}), "what is not allowed")
    server.end()
    print("ok")


if __name__ == "__main__":
    main()
