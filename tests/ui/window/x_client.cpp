#include "tests/ui/window/x_client.h"

#include <chrono>
#include <cstring>
#include <thread>

#include <X11/Xatom.h>
#include <X11/Xlib.h>

namespace
{

::Window find(Display* display, ::Window below, const std::string& title)
{
    char* name = nullptr;
    if (XFetchName(display, below, &name) && name) {
        const bool fits = title == name;
        XFree(name);
        if (fits) return below;
    }
    ::Window root = 0, parent = 0, *children = nullptr, found = 0;
    unsigned count = 0;
    if (!XQueryTree(display, below, &root, &parent, &children, &count)) return 0;
    for (unsigned i = 0; i < count && !found; ++i) found = find(display, children[i], title);
    if (children) XFree(children);
    return found;
}

class Source
{
  public:
    Source(Display* display, ::Window target, std::string uri)
        : display_(display), target_(target), uri_(std::move(uri)),
          own_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0))
    {
        XSetSelectionOwner(display, atom("XdndSelection"), own_, CurrentTime);
    }

    bool drop()
    {
        send("XdndEnter", 5L << 24, long(atom("text/uri-list")), 0, 0);
        send("XdndPosition", 0, 600L << 16 | 300, CurrentTime, long(atom("XdndActionCopy")));
        if (!wait("XdndStatus")) return false;
        send("XdndDrop", 0, CurrentTime, 0, 0);
        return wait("XdndFinished");
    }

  private:
    Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

    void send(const char* type, long one, long two, long three, long four)
    {
        XEvent event = {};
        event.xclient.type = ClientMessage;
        event.xclient.display = display_;
        event.xclient.window = target_;
        event.xclient.message_type = atom(type);
        event.xclient.format = 32;
        const long words[] = {long(own_), one, two, three, four};
        std::memcpy(event.xclient.data.l, words, sizeof(words));
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }

    // Until that message comes; meanwhile hands the file's name to whoever asks.
    bool wait(const char* type)
    {
        for (int i = 0; i < 500; ++i) {
            while (XPending(display_) > 0) {
                XEvent event;
                XNextEvent(display_, &event);
                if (event.type == SelectionRequest) answer(event.xselectionrequest);
                if (event.type == ClientMessage && event.xclient.message_type == atom(type)) return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    void answer(const XSelectionRequestEvent& request)
    {
        XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(uri_.data()), int(uri_.size()));
        XEvent event = {};
        event.xselection.type = SelectionNotify;
        event.xselection.requestor = request.requestor;
        event.xselection.selection = request.selection;
        event.xselection.target = request.target;
        event.xselection.property = request.property;
        event.xselection.time = request.time;
        XSendEvent(display_, request.requestor, False, NoEventMask, &event);
        XFlush(display_);
    }

    Display* display_;
    ::Window target_;
    std::string uri_;
    ::Window own_;
};

} // namespace

bool dropFile(const std::string& windowTitle, const std::string& file)
{
    Display* display = XOpenDisplay(nullptr);
    if (!display) return false;
    const ::Window target = find(display, DefaultRootWindow(display), windowTitle);
    const bool dropped = target && Source(display, target, "file://" + file + "\r\n").drop();
    XCloseDisplay(display);
    return dropped;
}

void setDpi(int dotsPerInch)
{
    Display* display = XOpenDisplay(nullptr);
    if (!display) return;
    const std::string words = "Xft.dpi:\t" + std::to_string(dotsPerInch) + "\n";
    XChangeProperty(display, DefaultRootWindow(display), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(words.data()), int(words.size()));
    XSetCloseDownMode(display, RetainPermanent); // else the server forgets with its last client
    XCloseDisplay(display);
}
