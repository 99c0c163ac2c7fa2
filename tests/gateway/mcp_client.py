#!/usr/bin/env python3
"""Speaks MCP as a client does: mcp_client.py REVISION COMMAND...   starts the server COMMAND and holds a conversation with it.

Prints what it finds wrong and ends with 1, or `ok`.
"""
import json
import subprocess
import sys


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
        answer = json.loads(line)
        expect(answer["jsonrpc"] == "2.0" and answer["id"] == self.last, f"{method}: {line}")
        return answer

    def call(self, name, **arguments):
        return self.ask("tools/call", name=name, arguments=arguments)["result"]


def expect(right, what):
    if not right:
        sys.exit(f"mcp_client: wrong: {what}")


def main():
    revision, *command = sys.argv[1:]
    server = Server(command)
    begun = server.ask("initialize", protocolVersion=revision, capabilities={}, clientInfo={"name": "test", "version": "1"})
    expect(begun["result"]["protocolVersion"] == revision, begun)
    server.say(method="notifications/initialized")
    tools = {tool["name"]: tool for tool in server.ask("tools/list")["result"]["tools"]}
    expect(set(tools) == {"SSM_Rate", "SSM_Text", "SSM_Text_next", "SSM_Text_text", "SSM_Text_pho", "SSM_Text_dur"}, sorted(tools))
    for tool in tools.values():
        expect(tool["description"] and tool["inputSchema"]["type"] == "object", tool)
    expect(tools["SSM_Rate"]["inputSchema"]["properties"]["value"] == {"type": "number", "minimum": 0.25, "maximum": 4.0},
           tools["SSM_Rate"])
    expect(server.call("SSM_Rate", value=2)["content"][0]["text"] == "2", "set Rate")
    expect(server.call("SSM_Rate")["content"][0]["text"] == "2", "inq Rate")
    wrong = server.call("SSM_Rate", value=9)
    expect(wrong["isError"] and "BAD_VALUE" in wrong["content"][0]["text"], wrong)
    spoken = server.call("SSM_Text", value="Good morning.")
    expect(not spoken["isError"], spoken)
    expect("[" in server.call("SSM_Text_pho")["content"][0]["text"], "inq Text.pho")
    expect("error" in server.ask("tools/call", name="SSM_SaveWAV", arguments={"value": "x"}), "what is not allowed")
    server.process.stdin.close()
    expect(server.process.stdout.read() == "", "nothing more is said")
    expect(server.process.wait(20) == 0, f"exit status {server.process.returncode}")
    print("ok")


if __name__ == "__main__":
    main()
