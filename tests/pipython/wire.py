"""What goes over the wire, written down."""


def overheard(gateway, write):
    """`gateway`, whose bytes are given to `write` besides, after ">" or "<"; it may be closed twice, as PIPython does."""
    send, read, close = gateway.send, gateway.read, gateway.close

    def told(sign, text):
        if text:
            write(sign, text.encode("latin-1", "replace"))

    def told_send(message):
        told(">", message)
        send(message)

    def told_read():
        text = read()
        told("<", text)
        return text

    def close_once():
        if gateway.connected:
            close()

    gateway.send, gateway.read, gateway.close = told_send, told_read, close_once
    return gateway
