// The Model Context Protocol's own client against mcp, over HTTP or, with a command, over standard input and output:
//     node mcp.mjs http://HOST:PORT/mcp?token=TOKEN         node mcp.mjs build/bin/mcp --connect ... --allow ...
// Tools of @SSM Rate and @SSM Text* must be allowed.
import assert from "node:assert/strict";
import { Client } from "@modelcontextprotocol/sdk/client/index.js";
import { StdioClientTransport } from "@modelcontextprotocol/sdk/client/stdio.js";
import { StreamableHTTPClientTransport } from "@modelcontextprotocol/sdk/client/streamableHttp.js";

const [first, ...args] = process.argv.slice(2);

function transport() {
  if (!first.startsWith("http")) return new StdioClientTransport({ command: first, args });
  const url = new URL(first);
  const token = url.searchParams.get("token");
  url.search = "";
  return new StreamableHTTPClientTransport(url, { requestInit: { headers: { Authorization: "Bearer " + token } } });
}

const client = new Client({ name: "galatea-check", version: "1" });
const errors = [];
client.onerror = (error) => errors.push(String(error));
const road = transport();
await client.connect(road);
assert.equal(client.getServerVersion().name, "galatea");
const { tools } = await client.listTools();
const rate = tools.find((tool) => tool.name === "SSM_Rate");
assert.deepEqual(rate.inputSchema.properties.value, { type: "number", minimum: 0.25, maximum: 4 });
assert.equal((await client.callTool({ name: "SSM_Rate", arguments: { value: 2 } })).content[0].text, "2");
assert.equal((await client.callTool({ name: "SSM_Rate", arguments: {} })).content[0].text, "2");
assert.equal((await client.callTool({ name: "SSM_Rate" })).content[0].text, "2");
const refused = await client.callTool({ name: "SSM_Rate", arguments: { value: 9 } });
assert.ok(refused.isError && /BAD_VALUE/.test(refused.content[0].text));
await assert.rejects(client.callTool({ name: "SSM_SaveWAV", arguments: { value: "x" } }), (e) => e.code === -32602);
await client.ping();
// Many at a time.
const texts = await Promise.all([1, 2, 3, 4, 5, 6, 7, 8].map(() => client.callTool({ name: "SSM_Rate" })));
assert.ok(texts.every((answer) => answer.content[0].text === "2"));
if (road instanceof StreamableHTTPClientTransport) await road.terminateSession();
await client.close();
assert.deepEqual(errors, []);
console.log(`mcp (${first.startsWith("http") ? "HTTP" : "standard streams"}): ok`);
