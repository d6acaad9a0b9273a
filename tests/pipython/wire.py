"""What goes over the wire, written down."""


def overheard(gateway, write):
    """`gateway`, each message of which is given to `write` as a line besides; it may be closed twice, as PIPython does."""
    send, read, close = gateway.send, gateway.read, gateway.close

    def told(sign, text):
        if text:
            write(f"{sign} {text.encode('latin-1', 'replace')!r}")

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
