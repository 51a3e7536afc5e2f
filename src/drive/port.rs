//! Ports: serial lines, pseudo-terminals and network sockets, behind one trait.

use super::error::DriveError;
use serialport::{FlowControl, SerialPort, SerialPortType};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

/// Longest time that the other side may take to accept bytes.
const PATIENCE: Duration = Duration::from_secs(5);

/// A connection to a machine. Both directions may stall; neither may lose bytes.
pub trait Port: Send {
    /// Sends all bytes.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Receives what has arrived. Waits up to `wait` for the first byte; 0 bytes mean that nothing came.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize>;
}

/// What keeps a fast computer from overrunning a slow machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Handshake {
    /// The protocol itself.
    #[default]
    None,
    /// XON and XOFF.
    Software,
    /// RTS and CTS.
    Hardware,
}

/// How a serial line is opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineSettings {
    /// Bits per second.
    pub baud: u32,
    /// Flow control.
    pub handshake: Handshake,
}

/// A port that this computer has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundPort {
    /// Its name, as `--port` takes it.
    pub name: String,
    /// What is connected, as far as the system knows.
    pub what: String,
    /// True for a USB device, which a plotter mostly is.
    pub is_usb: bool,
}

/// The serial ports of this computer, USB devices first.
pub fn ports() -> Result<Vec<FoundPort>, DriveError> {
    let found = serialport::available_ports().map_err(|error| DriveError::Listing(error.to_string()))?;
    let mut ports: Vec<FoundPort> = found.into_iter().map(described).collect();
    ports.sort_by_key(|port| (!port.is_usb, port.name.clone()));
    Ok(ports)
}

fn described(port: serialport::SerialPortInfo) -> FoundPort {
    let (what, is_usb) = match port.port_type {
        SerialPortType::UsbPort(usb) => {
            let names: Vec<String> = [usb.manufacturer, usb.product].into_iter().flatten().collect();
            let named = if names.is_empty() { "USB".to_owned() } else { names.join(" ") };
            (format!("{named} ({:04x}:{:04x})", usb.vid, usb.pid), true)
        }
        SerialPortType::BluetoothPort => ("Bluetooth".to_owned(), false),
        SerialPortType::PciPort => ("built in".to_owned(), false),
        SerialPortType::Unknown => (String::new(), false),
    };
    FoundPort { name: port.port_name, what, is_usb }
}

/// Opens a port: `tcp://host:port` is a socket, anything else a serial line or a pseudo-terminal, which no other program may use
/// meanwhile.
pub fn open_port(name: &str, settings: LineSettings) -> Result<Box<dyn Port>, DriveError> {
    let refused = |error: io::Error| DriveError::Opening { port: name.to_owned(), error };
    if let Some(address) = name.strip_prefix("tcp://") {
        return Ok(Box::new(open_socket(address).map_err(refused)?));
    }
    let flow = match settings.handshake {
        Handshake::None => FlowControl::None,
        Handshake::Software => FlowControl::Software,
        Handshake::Hardware => FlowControl::Hardware,
    };
    let builder = serialport::new(name, settings.baud).flow_control(flow).timeout(PATIENCE);
    Ok(Box::new(SerialLine { port: builder.open().map_err(|error| refused(error.into()))? }))
}

fn open_socket(address: &str) -> io::Result<Socket> {
    // Telnet's port, on which FluidNC listens.
    let with_port = if address.contains(':') { address.to_owned() } else { format!("{address}:23") };
    let mut last = io::Error::new(ErrorKind::NotFound, "no such host");
    for place in with_port.to_socket_addrs()? {
        match TcpStream::connect_timeout(&place, PATIENCE) {
            Ok(stream) => {
                stream.set_nodelay(true)?;
                stream.set_write_timeout(Some(PATIENCE))?;
                return Ok(Socket { stream });
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

struct SerialLine {
    port: Box<dyn SerialPort>,
}

impl Port for SerialLine {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.set_timeout(PATIENCE)?;
        self.port.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.port.set_timeout(wait.max(Duration::from_millis(1)))?;
        heard(self.port.read(buffer))
    }
}

struct Socket {
    stream: TcpStream,
}

impl Port for Socket {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.stream.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.stream.set_read_timeout(Some(wait.max(Duration::from_millis(1))))?;
        match self.stream.read(buffer) {
            Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
            read => heard(read),
        }
    }
}

/// Silence is no error.
fn heard(read: io::Result<usize>) -> io::Result<usize> {
    match read {
        Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted) => Ok(0),
        // A serial line whose other end is gone reads as ready and empty.
        Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
        other => other,
    }
}
