"""The Model Context Protocol's own Python client against mcp over HTTP:

    python3 mcp_client.py http://HOST:PORT/mcp?token=TOKEN

Tools of @SSM Rate and @SSM Text* must be allowed, and Rate be 2.
"""
import asyncio
import importlib.metadata
import sys

from mcp import ClientSession
from mcp.client.streamable_http import streamablehttp_client


async def main():
    url, token = sys.argv[1].split("?token=")
    async with streamablehttp_client(url, headers={"Authorization": "Bearer " + token}) as (read, write, _):
        async with ClientSession(read, write) as session:
            assert (await session.initialize()).serverInfo.name == "galatea"
            tools = {tool.name: tool for tool in (await session.list_tools()).tools}
            assert tools["SSM_Rate"].inputSchema["properties"]["value"] == {"type": "number", "minimum": 0.25, "maximum": 4}
            answers = await asyncio.gather(*(session.call_tool("SSM_Rate", {}) for _ in range(8)))
            assert all(answer.content[0].text == "2" for answer in answers)
            refused = await session.call_tool("SSM_Rate", {"value": 9})
            assert refused.isError and "BAD_VALUE" in refused.content[0].text
            await session.send_ping()
    print(f"mcp for Python {importlib.metadata.version('mcp')}: ok")

asyncio.run(main())
