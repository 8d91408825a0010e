"""A Modbus device by pymodbus, on TCP or a serial line, filled and read with Python's struct.

Usage: pymodbus_server.py tcp | rtu LINE
Holding and input registers 0, 10, 20 ... hold the values of TYPES in each order. What a client
writes to 1000, 1010, 1020 ... is taken apart in the same layouts and printed: "wrote INDEX VALUE".
"""
import asyncio
import struct
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer
from pymodbus.transaction import ModbusRtuFramer

TYPES = [("h", -12345), ("H", 54321), ("i", -123456789), ("I", 3456789012), ("f", -1234.5678)]
ORDERS = ["ABCD", "CDAB", "BADC", "DCBA"]
LAYOUTS = [(code, order, value) for code, value in TYPES for order in ORDERS]


def permuted(data, order):
    if len(data) == 2:
        order = "AB" if order in ("ABCD", "CDAB") else "BA"
    return bytes(data["ABCD".index(letter)] for letter in order)


def registers_of(code, order, value):
    data = permuted(struct.pack(">" + code, value), order)
    return list(struct.unpack(f">{len(data) // 2}H", data))


class Holding(ModbusSequentialDataBlock):
    def setValues(self, address, values):
        super().setValues(address, values)
        if address >= 1000 and address % 10 == 0:
            index = (address - 1000) // 10
            code, order, _ = LAYOUTS[index]
            data = struct.pack(f">{len(values)}H", *values)
            value = struct.unpack(">" + code, permuted(data, order))[0]
            print("wrote", index, repr(value), flush=True)


async def main():
    filled = [0] * 2000
    for index, (code, order, value) in enumerate(LAYOUTS):
        words = registers_of(code, order, value)
        filled[10 * index : 10 * index + len(words)] = words
    filled[500] = 4242
    slave = ModbusSlaveContext(
        hr=Holding(0, list(filled)), ir=ModbusSequentialDataBlock(0, list(filled)),
        co=ModbusSequentialDataBlock(0, [0, 1, 0, 1]), di=ModbusSequentialDataBlock(0, [1, 0, 1, 1]),
        zero_mode=True)
    context = ModbusServerContext(slaves=slave, single=True)
    if sys.argv[1] == "tcp":
        server = ModbusTcpServer(context, address=("127.0.0.1", 0))
        task = asyncio.ensure_future(server.serve_forever())
        await server.serving
        print("port", server.server.sockets[0].getsockname()[1], flush=True)
        await task
    else:
        server = ModbusSerialServer(context, framer=ModbusRtuFramer, port=sys.argv[2], baudrate=115200,
                                    parity="N", stopbits=1, bytesize=8, timeout=0.5)
        await server.start()
        print("port 0", flush=True)
        await server.serve_forever()


asyncio.run(main())
