"""What a host does with pyLSV2 to a machine that `bahn link serve --identity iTNC530` serves.

Arguments: the port, and a folder for files. The first deviation ends it with a traceback.
"""

import hashlib
import os
import pathlib
import sys
import time

import pyLSV2
from pyLSV2 import DriveName, ExecState, KeyCode, Login, MemoryType, PgmState

PORT = int(sys.argv[1])
HERE = pathlib.Path(sys.argv[2])


def connected(safe=True):
    return pyLSV2.LSV2("127.0.0.1", port=PORT, timeout=20, safe_mode=safe)


def is_equal(what, expected):
    assert what == expected, f"{what!r} is not {expected!r}"


def versions_and_logins():
    with connected() as host:
        assert host.versions.is_itnc(), host.versions.control
        assert [type(part) for part in (
            host.versions.nc_sw_base, host.versions.nc_sw_type, host.versions.nc_sw_version,
        )] == [int, int, int]
        is_equal(host.versions.plc, "MAIN.PLC")
        is_equal(host.parameters.max_block_length, 4096)
        assert host.login(Login.FILETRANSFER) and host.logout(Login.FILETRANSFER)
        assert host.login(Login.MONITOR)
        # Its own safe mode lets nothing else through.
        assert not host.login(Login.DNC)
        host.switch_safe_mode(False)
        assert host.login(Login.DNC) and host.login(Login.PLCDEBUG)
        host.logout(Login.FILEPLC)
        assert not host.login(Login.FILEPLC)
        assert not host.login(Login.FILEPLC, password="123")
        assert host.login(Login.FILEPLC, password="807667")
        assert "PLC:\\MAIN.PLC" in host.get_file_list("PLC:\\")


def folders():
    with connected() as host:
        is_equal(sorted(drive.name for drive in host.drive_info()), ["PLC:", "TNC:"])
        assert host.change_directory("TNC:/")
        is_equal(host.directory_info().path, "TNC:\\")
        names = {entry.name for entry in host.directory_content()}
        assert {"CIRCLE.H", "TOOL.T"} <= names, names
        entry = host.file_info("TNC:/CIRCLE.H")
        assert entry.size > 0 and not entry.is_directory and not entry.is_protected
        assert host.file_info("TNC:/TOOL.T").is_protected
        assert host.file_info("TNC:/NONE.H") is None

        assert host.make_directory("TNC:/HOST/T1/T2/T3")
        assert host.file_info("TNC:/HOST/T1").is_directory
        assert host.delete_empty_directory("TNC:/HOST/T1/T2/T3")
        assert not host.change_directory("TNC:/HOST/T1/T2/T3")
        assert host.change_directory("TNC:/HOST/T1/T2")
        # A folder goes although somebody is in it.
        assert host.delete_empty_directory("TNC:/HOST/T1/T2")
        assert not host.delete_empty_directory("TNC:/HOST")
        flat = host.get_file_list(DriveName.TNC + "\\", descend=False)
        (HERE / "deep.h").write_text("BEGIN PGM DEEP MM\nEND PGM DEEP MM\n")
        assert host.send_file(HERE / "deep.h", "TNC:/HOST/T1/DEEP.H")
        deep = host.get_file_list(DriveName.TNC + "\\")
        assert "TNC:\\HOST\\T1\\DEEP.H" in deep and "TNC:\\HOST\\T1\\DEEP.H" not in flat
        is_equal(host.get_file_list(DriveName.TNC + "\\", pattern=r"[CD].*\.H$"),
                 ["TNC:\\CIRCLE.H", "TNC:\\DATUM.H", "TNC:\\HOST\\T1\\DEEP.H"])
        assert host.delete_file("TNC:/HOST/T1/DEEP.H")
        assert host.delete_empty_directory("TNC:/HOST/T1")
        assert host.delete_empty_directory("TNC:/HOST")


def files():
    with connected() as host:
        assert host.make_directory("TNC:/HOST")
        assert host.copy_remote_file("TNC:/CIRCLE.H", "TNC:/HOST/aa.h")
        assert host.change_directory("TNC:/")
        assert host.copy_remote_file("CIRCLE.H", "TNC:/HOST/bb.h")
        assert host.copy_remote_file("TNC:/CIRCLE.H", "TNC:/HOST/")
        assert not host.copy_remote_file("TNC:/CIRCLE.H", "TNC:/HOST/aa.h")
        assert host.move_file("TNC:/HOST/bb.h", "TNC:/HOST/cc.h")
        assert not host.move_file("TNC:/HOST/aa.h", "TNC:/HOST/cc.h")
        assert host.file_info("TNC:/HOST/bb.h") is None
        size = host.file_info("TNC:/CIRCLE.H").size
        for name in ("aa.h", "cc.h", "CIRCLE.H"):
            is_equal(host.file_info("TNC:/HOST/" + name).size, size)
            assert host.delete_file("TNC:/HOST/" + name)
        assert host.delete_empty_directory("TNC:/HOST")
        # What is protected stays.
        assert not host.delete_file("TNC:/TOOL.T")
        assert not host.move_file("TNC:/TOOL.T", "TNC:/HIS.T")


def transfers():
    text = b"".join(b"%d L X+%d,5 R0 F200\r\n" % (line, line) for line in range(5000))
    binary = os.urandom(1_000_000) + bytes(range(256)) * 40
    with connected() as host:
        for name, content, is_binary in (("text.h", text, False), ("empty.h", b"", False), ("data.bin", binary, True)):
            sent, received = HERE / name, HERE / ("back-" + name)
            sent.write_bytes(content)
            remote = "TNC:/" + name.upper()
            assert host.send_file(sent, remote, binary_mode=is_binary)
            # Without the word for it nothing is replaced.
            assert not host.send_file(sent, remote, binary_mode=is_binary)
            assert host.send_file(sent, remote, override_file=True, binary_mode=is_binary)
            is_equal(host.file_info(remote).size, len(content))
            assert host.recive_file(remote, received, binary_mode=is_binary)
            digests = [hashlib.sha256(path.read_bytes()).hexdigest() for path in (sent, received)]
            is_equal(digests[0], digests[1])
            assert host.delete_file(remote)
        for bad in ("TNC:/../OUT.H", "TNC:/A*B.H", "TNC:/" + 41 * "A"):
            assert not host.send_file(HERE / "text.h", bad) if ".." not in bad else refused(host, bad)
        table = HERE / "tool.t"
        assert host.recive_file("TNC:/TOOL.T", table)
        tools = pyLSV2.NCTable.parse_table(table)
        assert "T" in tools.column_names and "R" in tools.column_names, tools.column_names
        assert len(tools) > 3 and tools.rows[0]["T"].isdigit(), tools.rows[:1]


def refused(host, path):
    """A path that leads out is refused, whichever way the library finds that out."""
    try:
        return not host.send_file(HERE / "text.h", path)
    except pyLSV2.LSV2StateException:
        return True


def run_information():
    with connected(safe=False) as host:
        assert host.program_status() in list(PgmState)[:8]
        is_equal(host.program_stack().line_no, 0)
        is_equal(host.execution_state(), ExecState.MANUAL)
        override = host.override_state()
        assert 0 <= override.feed <= 150 and 0 <= override.spindle <= 150
        axes = host.axes_location()
        assert {"X", "Y", "Z"} <= set(axes) and all(isinstance(value, float) for value in axes.values())
        tool = host.spindle_tool_status()
        assert tool.number >= 0 and tool.axis == "Z" and tool.length >= 0
        is_equal([message.e_text for message in host.get_error_messages()], ["POWER INTERRUPTED"])
        assert abs(host.get_remote_datetime().timestamp() - time.time()) < 60


def memory_and_parameters():
    with connected(safe=False) as host:
        for kind in MemoryType:
            is_equal(len(host.read_plc_memory(0, kind, 2)), 2)
        is_equal(len(host.read_plc_memory(0, MemoryType.MARKER, 500)), 500)
        for address in ("M4095", "W1024"):
            try:
                host.read_plc_address(address)
                raise AssertionError(address)
            except pyLSV2.LSV2InputException:
                pass
        for path in ("/PLC/memory/M/1", "/PLC/memory/B/1", "/PLC/memory/W/2", "/PLC/memory/D/4",
                     "/PLC/memory/I/1", "/PLC/memory/S/1", "\\PLC\\memory\\K\\1"):
            assert host.read_data_path(path) is not None, path
        is_equal(host.read_data_path("/PLC/memory/K/1"), 1)
        assert host.read_data_path("/TABLE/TOOL/T/1/R") > 0
        assert host.read_data_path("/TABLE/TOOL/T/9999/R") is None

        value = host.get_machine_parameter("7230.0")
        assert value.isdigit() and host.get_machine_parameter("7230") == value
        is_equal(host.get_machine_parameter("9999"), "")
        other = "0" if value == "1" else "1"
        assert host.set_machine_parameter("7230.0", other)
        is_equal(host.get_machine_parameter("7230"), other)
        assert host.set_machine_parameter("7230.0", value)
        assert host.set_machine_parameter("7230.0", other, safe_to_disk=True)
        assert not host.set_machine_parameter("7230.0", "900")


def keys_and_screen():
    picture = HERE / "screen.bmp"
    with connected(safe=False) as host:
        assert host.set_keyboard_access(False)
        for key, state in ((KeyCode.CE, ExecState.MANUAL), (KeyCode.MODE_PGM_EDIT, ExecState.MANUAL),
                           (KeyCode.MODE_AUTOMATIC, ExecState.AUTOMATIC), (KeyCode.MODE_SINGLE_STEP, ExecState.SINGLE_STEP),
                           (KeyCode.MODE_MANUAL, ExecState.MANUAL)):
            assert host.send_key_code(key)
            until(lambda: host.execution_state() == state, key)
        with connected(safe=False) as other:
            assert not other.send_key_code(KeyCode.CE)
        assert host.set_keyboard_access(True)
    with connected() as host:
        assert host.grab_screen_dump(picture)
        assert not [name for name in host.get_file_list("TNC:\\") if "screendump" in name.lower()]
    content = picture.read_bytes()
    is_equal(content[:2], b"BM")
    is_equal((int.from_bytes(content[18:22], "little"), int.from_bytes(content[22:26], "little")), (640, 480))
    # Not one colour all over: something is written on it.
    assert len({content[at:at + 3] for at in range(54, len(content), 3)}) > 3


def until(is_so, what):
    begin = time.time()
    while not is_so():
        assert time.time() < begin + 10, what
        time.sleep(0.02)


for deed in (versions_and_logins, run_information, folders, files, transfers, memory_and_parameters, keys_and_screen):
    deed()
    print(deed.__name__, flush=True)
