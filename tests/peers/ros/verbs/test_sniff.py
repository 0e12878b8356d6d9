"""`yarpy idl sniff`: a definition for what a port sends."""


def test_a_file_for_what_a_port_sends(cli, names):
    import yarpy

    with (
        yarpy.Port("/motor/state:o", names=names) as port,
        cli.start("idl", "sniff", "/motor/state:o") as sniffing,
    ):
        assert port.wait_for_outputs(timeout=10)
        port.write(yarpy.Vector([10.0, 20.0, 30.0, 40.0]))
        sniffing.wait_line(r"int32 v_tag # .*266")
        sniffing.wait_line(r"float64\[\] v ")
        assert sniffing.wait() == 0
