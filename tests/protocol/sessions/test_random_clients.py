"""The short form of random_clients.py."""

from harness.server import ServerTestCase
from random_clients import CONTROL, run, server_arguments


class RandomClients(ServerTestCase):
    arguments = server_arguments()

    def reset(self):
        self.server.headers["Authorization"] = "Bearer " + CONTROL

    async def test_a_hundred_histories_keep_the_contract(self):
        self.assertEqual(await run(self.server, 100), [])
